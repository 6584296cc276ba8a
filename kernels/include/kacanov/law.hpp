// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws: secant shear modulus g, its derivative and its energy.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kacanov {

/// g and its derivative.
struct Moduli {
  double secant, derivative;
};

/// The forms of g beyond the proportional range, each a struct of its parameters with
///
///   name                  its `type` in case files
///   parameters(f, visit)  calls visit(parameter) for each parameter of the form f
///   fault()               error message about the parameters, as in validate(); empty if they are valid
///   yield()               the argument a up to which g is constant
///   initial(mu)           g up to yield()
///   moduli(mu, a)         g and dg/da for a > yield()
///   energy(mu, a)         ∫ g a da from yield() to a > yield()
///   plain_energy(mu, a)   ∫ g da from yield() to a > yield(); forms without it do not support squares
///   proof()               the argument beyond which a point counts as plastic; forms without it use yield()
///
/// for the shear modulus mu and the argument a, a strain or its square: see Law::Argument.
namespace laws {

/// g = μ.
struct Linear {
  static constexpr std::string_view name = "linear";
  static void parameters(auto&, auto&&) {}
  std::string fault() const { return {}; }
  double yield() const { return std::numeric_limits<double>::infinity(); }
  double initial(double mu) const { return mu; }
  Moduli moduli(double mu, double) const { return {mu, 0.0}; }
  double energy(double, double) const { return 0.0; }
  double plain_energy(double, double) const { return 0.0; }
};

/// theory: law-logarithmic
struct Logarithmic {
  double x0 = 0.0;  ///< yield strain, > 0, in terms of the argument

  static constexpr std::string_view name = "logarithmic";
  static void parameters(auto& f, auto&& visit) { visit(f.x0); }
  std::string fault() const;
  double yield() const { return x0; }
  double initial(double mu) const { return mu; }
  Moduli moduli(double mu, double a) const;
  double energy(double mu, double a) const;
  double plain_energy(double mu, double a) const;
};

/// theory: law-linear-hardening
struct LinearHardening {
  double x0 = 0.0;     ///< as above
  double gamma = 1.0;  ///< 0 < γ ≤ 1: limit of g/μ at large strain

  static constexpr std::string_view name = "linear_hardening";
  static void parameters(auto& f, auto&& visit) { visit(f.x0), visit(f.gamma); }
  std::string fault() const;
  double yield() const { return x0; }
  double initial(double mu) const { return mu; }
  Moduli moduli(double mu, double a) const;
  double energy(double mu, double a) const;
  double plain_energy(double mu, double a) const;
};

/// theory: law-power
struct Power {
  double x0 = 0.0;  ///< as above
  double n = 1.0;   ///< 0 < n ≤ 1

  static constexpr std::string_view name = "power";
  static void parameters(auto& f, auto&& visit) { visit(f.x0), visit(f.n); }
  std::string fault() const;
  double yield() const { return x0; }
  double initial(double mu) const { return mu; }
  Moduli moduli(double mu, double a) const;
  double energy(double mu, double a) const;
  double plain_energy(double mu, double a) const;
};

/// theory: law-saturating
struct Saturating {
  double x0 = 0.0;  ///< as above
  double q = 1.0;   ///< > 0: the stress tends to (1 + q) times that at x0

  static constexpr std::string_view name = "saturating";
  static void parameters(auto& f, auto&& visit) { visit(f.x0), visit(f.q); }
  std::string fault() const;
  double yield() const { return x0; }
  double initial(double mu) const { return mu; }
  Moduli moduli(double mu, double a) const;
  double energy(double mu, double a) const;
  double plain_energy(double mu, double a) const;
};

/// theory: law-table. At least two points, from (0, 0); the last segment is extrapolated.
struct Table {
  std::vector<double> x;  ///< arguments, increasing
  std::vector<double> s;  ///< 2 g a = ‖dev τ‖ there, increasing, s/x not increasing

  static constexpr std::string_view name = "table";
  static void parameters(auto& f, auto&& visit) { visit(f.x), visit(f.s); }
  std::string fault() const;
  double yield() const { return x[1]; }
  double initial(double) const { return 0.5 * s[1] / x[1]; }
  Moduli moduli(double mu, double a) const;
  double energy(double mu, double a) const;
  double plain_energy(double mu, double a) const;
};

/// theory: law-ramberg-osgood. x/x0 = t + a tⁿ, t = s/(2μ x0).
struct RambergOsgood {
  double x0 = 0.0;  ///< > 0: elastic strain at the reference stress
  double a = 0.0;   ///< > 0: ratio of plastic to elastic strain at the reference stress
  double n = 2.0;   ///< > 1

  static constexpr std::string_view name = "ramberg_osgood";
  static void parameters(auto& f, auto&& visit) { visit(f.x0), visit(f.a), visit(f.n); }
  std::string fault() const;
  double yield() const;
  double proof() const { return x0 * (1.0 + a); }
  double initial(double mu) const { return mu; }
  Moduli moduli(double mu, double x) const;
  double energy(double mu, double x) const;
};

}  // namespace laws

/// τ = k0 tr ε I + 2 g(x) dev ε, x = ‖dev ε‖ (Frobenius; theory: laws). Moduli have the unit of stress,
/// strains none. Every member function takes the norm x ≥ 0, whatever `argument` is.
struct Law {
  using Form = std::variant<laws::Linear, laws::Logarithmic, laws::LinearHardening, laws::Power,
                            laws::Saturating, laws::Table, laws::RambergOsgood>;
  /// The argument of the form: x or x² (theory: squared-argument).
  enum class Argument : std::uint8_t { norm, squared };

  Form form;
  Argument argument = Argument::norm;
  double bulk = 0.0;   ///< k0
  double shear = 0.0;  ///< μ = g(0); tables have their own
  /// k0 acts on an average of tr ε: over the element (theory: b-bar) or around its corners (theory:
  /// displacement-pressure), depending on Cell.
  bool mean_dilatation = false;

  /// True if g is constant.
  bool linear() const noexcept { return std::holds_alternative<laws::Linear>(form); }
  /// Computes g and dg/dx.
  Moduli moduli(double x) const;
  /// Secant modulus g.
  double secant(double x) const;
  /// dg/dx with respect to the norm x.
  double secant_derivative(double x) const;
  /// G(x) = ∫₀ˣ g(s) s ds; the energy density of a point is k0/2 tr² + 2 G(x) (theory: energy).
  double energy(double x) const;
  /// The norm up to which g is constant; infinite for linear laws.
  double yield_strain() const;
  /// The norm beyond which plastic() is true: the yield strain, or the strain at the reference stress for
  /// laws whose g decreases from zero strain on.
  double proof_strain() const;
  /// True where stress decreases with strain, d(g x)/dx < 0 (possible with the squared argument only).
  bool softens(double x) const;
  /// True beyond the proof strain.
  bool plastic(double x) const;
};

/// Returns an error message in the terms of the case file, such as "gamma: expected a number > 0 and ≤ 1, got
/// 0"; empty if the law is valid. Does not check whether the body's elements have a B-bar form.
std::string validate(const Law& law);

/// k0 = E / (3 (1 − 2ν)), μ = E / (2 (1 + ν)) from Young's modulus and Poisson's ratio, which are not
/// checked.
Law elastic_law(double young, double poisson);
/// Young's modulus from k0 and μ.
double young_modulus(const Law& law);

// Laws from tensile test data (theory: uniaxial), with the elastic constants of `elastic`.

/// Slope of a stress plateau, such as beyond the last row of a table, relative to 2μ. It keeps the
/// displacement unique.
inline constexpr double plateau_slope = 1e-4;
/// `rows`: (stress, plastic strain), first strain 0, strains increasing, stresses not decreasing. Beyond the
/// last row the stress has the slope plateau_slope. Empty rows and errors that validate() reports are not
/// checked.
laws::Table plastic_table(const Law& elastic, std::span<const std::array<double, 2>> rows);
/// Bilinear: `tangent` is the slope of stress over total strain beyond the yield stress, 0 < tangent < E.
laws::LinearHardening bilinear(const Law& elastic, double yield_stress, double tangent);
/// ε = σ/E + alpha (sigma0/E) (σ/sigma0)ⁿ.
laws::RambergOsgood ramberg_osgood(const Law& elastic, double sigma0, double alpha, double n);

}  // namespace kacanov
