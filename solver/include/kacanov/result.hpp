// SPDX-License-Identifier: BSD-3-Clause
// What a run reports: the numbers of result.json, and the fields of its output files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/cells.hpp>
#include <kacanov/model.hpp>
#include <kacanov/totals.hpp>

namespace kacanov {

/// `limited_by_rounding`: what this arithmetic can tell of the residuals is more than the tolerance, and the
/// run has come to where more steps change nothing (theory: rounding).
enum class Status { converged, limited_by_rounding, not_converged, interrupted };

/// The KKT residuals of a state, all relative to scales that it sets itself (theory: kkt, duality-gap,
/// rounding).
struct KktResiduals {
  double equilibrium = 0.0;  ///< ‖F − R(u) − Nᵀ M λ_n − Tᵀ M λ_t‖ on free components / force scale
  double penetration = 0.0;      ///< max (Nu − ρ)⁺ / displacement scale
  double tension = 0.0;          ///< max (−λ_n)⁺ / pressure scale
  double complementarity = 0.0;  ///< contact and friction products / (pressure × displacement × area)
  double friction_cone = 0.0;    ///< max (|λ_t| − ψ)⁺ / pressure scale
  double force_balance = 0.0;    ///< |loads + contact + reactions| / force scale
  double duality_gap = 0.0;      ///< |primal − dual energy| / energy scale

  /// The largest; infinite where one is no number.
  double worst() const noexcept;
};

/// A residual and what result.json and messages call it.
struct NamedResidual {
  const char* name;
  double KktResiduals::*member;
};
inline constexpr std::array residual_names{NamedResidual{"equilibrium", &KktResiduals::equilibrium},
                                           NamedResidual{"penetration", &KktResiduals::penetration},
                                           NamedResidual{"tension", &KktResiduals::tension},
                                           NamedResidual{"complementarity", &KktResiduals::complementarity},
                                           NamedResidual{"friction_cone", &KktResiduals::friction_cone},
                                           NamedResidual{"force_balance", &KktResiduals::force_balance},
                                           NamedResidual{"duality_gap", &KktResiduals::duality_gap}};

/// Small numbers in both, and nothing else, mean that the problem is solved (theory: kkt, rounding).
struct Certificate : KktResiduals {
  /// Down to which each residual can be known: what rounding leaves of it where it ought to be zero.
  KktResiduals rounding;

  /// Whether every residual with what rounding may hide in it is at most `tolerance`: the true one is then.
  bool meets(double tolerance) const noexcept;
  /// Whether none that is above `tolerance` can be told from rounding: more iterations change nothing.
  bool exhausted(double tolerance) const noexcept;
};

/// One Lanczos estimate of the spectrum of K = M^½ C B⁻¹ Cᵀ M^½, C = N or [N; T].
struct SpectrumResult {
  double lambda_min = 0.0, lambda_max = 0.0;
  double bound_min = 0.0, bound_max = 0.0;  ///< Ritz residual bounds, absolute, on each λ
  double r_star = 0.0;                      ///< theory: r-star
  bool converged = true;  ///< every solve and both Lanczos estimates; else λ and r* are rough
  int products = 0;       ///< products with K or K⁻¹, one solve each
  std::int64_t cg_iterations = 0;
  std::uint64_t operator_applications = 0;
  double seconds = 0.0;
  bool friction = false;    ///< C = [N; T]
  std::int64_t traces = 0;  ///< rows of C
};

/// The end of one load step.
struct LoadStep {
  double factor = 1.0;
  int outer_iterations = 0;        ///< of this step
  std::int64_t cg_iterations = 0;  ///< likewise
  std::int64_t active_nodes = 0, slip_nodes = 0;
  Vector3 contact_force{}, friction_force{};
  double max_contact_pressure = 0.0;
  std::int64_t plastic_elements = 0;
  double worst_residual = 0.0;  ///< of the certificate, by the operator of the loop
  std::vector<Vector3> probe;
  std::vector<double> travel;  ///< one a contact entry, 0 unless it is pushed; empty where nothing moves
};

/// How far the numbers are, by estimates, from those of a mesh without end (theory: error-estimate).
struct Discretisation {
  double energy = 0.0;  ///< of the strains, in the energy norm, relative
  int meshes = 1;       ///< of so many, each twice as fine as the one before, the numbers below are known
  std::vector<Vector3> probe;            ///< of the displacement there; empty of one mesh
  std::optional<Vector3> contact_force;  ///< nothing of one mesh, and without contact
};

/// Wall time of the phases of solve(), on this rank.
struct PhaseSeconds {
  double total = 0.0;
  double prepare = 0.0;               ///< operator and first state
  double spectrum = 0.0;              ///< estimates behind the first penalty
  double preconditioner_setup = 0.0;  ///< within the other phases
  double solve = 0.0;                 ///< outer steps
  double checkpoint = 0.0;            ///< written on the way
  double certificate = 0.0;           ///< by the reference operator, and the totals
};

struct Result {
  Status status = Status::not_converged;
  std::string message;
  std::vector<std::string> warnings;  ///< what may make the numbers less than they seem; one sentence each
  std::int64_t unknowns = 0, elements = 0;
  ElementType element = ElementType::tri3;
  std::int64_t contact_nodes = 0, active_nodes = 0, slip_nodes = 0;
  int outer_iterations = 0;
  int unsolved_steps = 0;    ///< of these, since a restart: a linear solve did not converge
  int restarted_after = -1;  ///< outer steps before a restart, which the counts include; −1 without one
  std::int64_t contact_iterations = 0, cg_iterations = 0;
  std::uint64_t operator_applications = 0;  ///< all purposes together
  std::uint64_t spectrum_applications = 0;  ///< of these: estimates of λ_min, λ_max, r_A
  std::uint64_t contact_applications =
      0;                  ///< of these: solves inside the contact loop; the rest are true residuals
  std::vector<double> r;  ///< one an outer step
  double lambda_min = 0.0, lambda_max = 0.0, r_star = 0.0;
  double r_active =
      0.0;  ///< r_n as ADMM ended with it, adapted to the contact set; 0 where only the first step used ADMM
  Vector3 contact_force{}, friction_force{};  ///< what the obstacles do to the body
  double bound_change = 0.0;  ///< Coulomb: what ψ moved by in the last step / largest pressure; 0 without
  double max_contact_pressure = 0.0, max_von_mises = 0.0;
  std::int64_t plastic_elements = 0;
  std::int64_t softening_elements = 0;   ///< in the softening range of a squared-argument law
  double plastic_share = 0.0;            ///< of the volume: elements beyond yield
  std::vector<ContactTotals> contact;    ///< one a contact entry
  std::vector<BoundaryTotals> reaction;  ///< one a displacement entry
  std::vector<BoundaryTotals> load;      ///< one an entry of another kind, times its factor at the end
  Extreme max_displacement;              ///< |u| at a node
  Extreme max_strain;                    ///< largest principal strain, or its opposite, at a quadrature point
  Extreme max_flow;             ///< norm of the strain deviator over that at yield; 0 where nothing yields
  Extreme max_rotation;         ///< angle of the infinitesimal rotation at a quadrature point, in radians
  Extreme max_von_mises_nodal;  ///< of recovered stress; for whoever calls recover_stress() to fill in
  BodySize body;
  Discretisation discretisation;  ///< for whoever calls estimate_error() to fill in
  std::vector<Vector3> probe;
  bool by_time = false;       ///< the factors of the load steps are times of the load curves
  double load_reached = 0.0;  ///< factor of the last state that converged; 0: none has
  double load_factor = 1.0;   ///< factor of the state that all numbers and fields are of
  int load_cuts = 0;          ///< how often a load step, or a part of one, was halved because it did not
  std::vector<LoadStep> load_steps;  ///< those that are over; empty where the load is put on at once
  Certificate certificate;
  PhaseSeconds seconds;
  int ranks = 1, threads = 1;
  std::string instruction_set;
};

/// State of a contact point.
enum class ContactStatus : std::uint8_t { open, stick, slip };  ///< frictionless contact: slip

/// This rank's fields, in the numbering of its Part. Those of elements follow from the displacement:
/// element_fields.hpp.
struct Solution {
  Result result;                     ///< the same on every rank
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double>
      thermal;  ///< the pressure that temperature takes off, as in ThermalPressure; empty: none
  std::vector<double> corner_dilatation;  ///< elements × 4: means of tr ε round their corners; empty where no
                                          ///< law asks for them (theory: displacement-pressure)
  std::vector<double> gap;                    ///< contact points: ρ − Nu, the open distance
  std::vector<double> pressure;               ///< contact points: λ_n
  std::vector<Vector3> traction;              ///< contact points: −λ_t, what the obstacle does to the body
  std::vector<ContactStatus> contact_status;  ///< contact points
};

}  // namespace kacanov
