// SPDX-License-Identifier: BSD-3-Clause
// The fast operator: block layout, threads, instruction set; in double and in single precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include <kacanov/reference.hpp>

namespace kacanov {

struct OperatorOptions {
  int threads = 1;  ///< threads of this operator, ≥ 1
  /// "avx512", "avx2" or "plain"; empty: KACANOV_INSTRUCTION_SET, or else the best that the machine supports
  std::string_view instruction_set;
  /// Nodes whose values are needed first, such as interface nodes shared with other processes; see
  /// OnInterfaceReady.
  std::span<const std::int32_t> early = {};
};

/// Callback for the time when y has its final values at the early nodes and the rest is still being computed,
/// so that these values can be sent meanwhile. Runs on the calling thread and may change y there. y has the
/// same bits with and without it.
using OnInterfaceReady = std::function<void()>;
using WhenEarly = OnInterfaceReady;  ///< old name, for one release

/// y = B(g) x and the operations that a solver needs with it (theory: operator), in the precision of `Real`.
/// The constructor copies what it needs of the body's arrays; they need not outlive it.
///
/// Vectors have nodes × dim entries, interleaved, in the caller's numbering; any numbering works, that of
/// locality_order() is the fastest. Displacements have the caller's unit of length, moduli and stresses the
/// same unit, forces that unit times an area (a length in 2D, for unit thickness). g has elements × points
/// entries in the caller's order of elements; in the interface it is always in double precision.
///
/// Results have the same bits in every run with the same threads and instruction set. Non-const members share
/// scratch memory: one call at a time. Members throw std::invalid_argument if a length is wrong, the
/// constructor also if anything else is wrong with the body or the options.
///
/// In single precision, coordinates are stored relative to the centre of each block; the relative error is
/// about 1e-6 on well-shaped elements. Sums (xᵀ y, energies) are in double precision in any case.
template <class Real>
class BasicOperator {
 public:
  explicit BasicOperator(const Body& body, const OperatorOptions& options = {});
  /// Uses the partitioning of `like`, which must have the same mesh and law_of_element; laws and options may
  /// differ. Takes a fifth of the time. `like` need not outlive it.
  BasicOperator(const Body& body, const OperatorOptions& options, const BasicOperator<double>& like);
  ~BasicOperator();
  BasicOperator(BasicOperator&&) noexcept;
  BasicOperator& operator=(BasicOperator&&) noexcept;

  std::size_t unknowns() const noexcept;

  /// For tr ε averaged around corners (CornerMeans) that have elements on other processes too: `sum` must sum
  /// the entries, those of corner_means() of this body, over all processes. It is called immediately, and
  /// later by every product, residual and energy, which therefore become collective. An empty function
  /// removes it.
  void set_corner_sum(std::function<void(std::span<Real>)> sum);
  /// Plane stress: sets Body::free_strain, one entry per element. Functions of a displacement use it, B(g)
  /// and B_T do not. Empty: zero, the initial state. Throws std::logic_error for other bodies.
  void set_free_strain(std::span<const double> of_element);
  /// Freezes g at the displacement u. Initially g = μ.
  void update(std::span<const Real> u);
  /// Writes the frozen g to `g`, rounded to Real.
  void secant(std::span<double> g) const;
  void set_secant(std::span<const double> g);
  /// y = B(g) x (overwrites y).
  void apply(std::span<const Real> x, std::span<Real> y, const OnInterfaceReady& on_interface_ready = {});
  /// y = B(g) x; returns xᵀ y, without any change that `on_interface_ready` makes.
  double apply_dot(std::span<const Real> x, std::span<Real> y,
                   const OnInterfaceReady& on_interface_ready = {});
  /// y_v = B(g) x_v for `vectors` ≥ 1 input vectors, stored one after another; the element geometry is
  /// computed once for up to four of them.
  void apply_many(std::span<const Real> x, std::span<Real> y, int vectors);
  /// Diagonal of B(g), nodes × dim. Where tr ε is averaged around corners: the diagonal with tr ε at the
  /// points instead, an upper bound.
  void diagonal(std::span<Real> d) const;
  /// Diagonal blocks of B(g), nodes × dim × dim, each block row-major; the same bound as in diagonal().
  /// `wanted`: one flag per node, or empty for all nodes; blocks of nodes without the flag may be incomplete.
  void block_diagonal(std::span<Real> blocks, std::span<const char> wanted = {}) const;

  // The parts of B(g) = A + Bᵀ C⁻¹ B where tr ε is averaged around corners, for preconditioners (theory:
  // displacement-pressure). C: corner volumes over k0; p (stress) and q (volume): one entry per entry of
  // corner_means() of this body. They throw std::logic_error where nothing is averaged.

  /// Number of entries of p; 0 where nothing is averaged.
  std::size_t pressures() const noexcept;
  /// y = A x + Bᵀ p; y = A x if p is empty.
  void apply_deviator(std::span<const Real> x, std::span<const Real> p, std::span<Real> y,
                      const OnInterfaceReady& on_interface_ready = {});
  /// y = Bᵀ p.
  void pressure_force(std::span<const Real> p, std::span<Real> y,
                      const OnInterfaceReady& on_interface_ready = {});
  /// q = B x, the contribution of this process.
  void volume_change(std::span<const Real> x, std::span<Real> q);
  /// Diagonal blocks of A; arguments as in block_diagonal().
  void block_diagonal_deviator(std::span<Real> blocks, std::span<const char> wanted = {}) const;

  /// Freezes the tangent (and g) at u for apply_tangent.
  void update_tangent(std::span<const Real> u);
  /// y = B_T x with the tangent frozen last, even if g has changed since. The direction of dev ε in its
  /// rank-one term is stored in single precision (relative error 1e-7 of that term). Throws std::logic_error
  /// before the first update_tangent.
  void apply_tangent(std::span<const Real> x, std::span<Real> y,
                     const OnInterfaceReady& on_interface_ready = {});
  /// y = B_T x; returns xᵀ y as apply_dot() does.
  double apply_tangent_dot(std::span<const Real> x, std::span<Real> y,
                           const OnInterfaceReady& on_interface_ready = {});
  /// The tangent version of apply_many().
  void apply_tangent_many(std::span<const Real> x, std::span<Real> y, int vectors);
  /// Diagonal and diagonal blocks of B_T, like those of B(g). Throw std::logic_error before update_tangent.
  void diagonal_tangent(std::span<Real> d) const;
  void block_diagonal_tangent(std::span<Real> blocks) const;
  /// Copies the frozen tangent of `from`, an operator of the same body; g stays. Throws std::logic_error if
  /// `from` has no tangent.
  void take_tangent(const BasicOperator<double>& from);
  /// Frees the tangent's memory, 20 bytes per element point. Functions that need the tangent throw until the
  /// next update_tangent.
  void forget_tangent() noexcept;

  /// Internal force f of the true law at u; does not use the frozen g.
  void residual(std::span<const Real> u, std::span<Real> f);
  /// Stored energy of the true law at u (theory: energy).
  double energy(std::span<const Real> u);
  /// Computes residual, energy and new g in one pass; returns the energy.
  double residual_energy_update(std::span<const Real> u, std::span<Real> f);

  // User-defined law: the caller evaluates it from strain() and passes its moduli to the functions below,
  // which use them instead of the body's laws; these still provide k0. set_secant() takes g.

  /// Writes ‖dev ε‖ at every point, elements × points, to `x`; does not use g.
  void strain(std::span<const Real> u, std::span<double> x);
  /// Freezes the tangent and g of these moduli at u. Needs `derivative`.
  void update_tangent(std::span<const Real> u, const PointModuli& moduli);
  /// Internal force f at u, skipped if f is empty; does not use the frozen g. Returns the energy, or 0 if
  /// `energy` is empty.
  double residual_energy(std::span<const Real> u, const PointModuli& moduli, std::span<Real> f);

  /// Instruction set of the loops in use: "avx512", "avx2" or "plain".
  std::string_view instruction_set() const noexcept;
  /// Memory of this operator in bytes, index data included.
  std::size_t bytes() const noexcept;
  /// Number of applications of B to a vector since construction, secant and tangent.
  std::uint64_t applications() const noexcept;

 private:
  template <class>
  friend class BasicOperator;
  struct Data;
  std::unique_ptr<Data> data_;
};

extern template class BasicOperator<double>;
extern template class BasicOperator<float>;

using Operator = BasicOperator<double>;
/// For preconditioners and mixed-precision solvers.
using FloatOperator = BasicOperator<float>;

}  // namespace kacanov
