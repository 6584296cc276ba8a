// SPDX-License-Identifier: BSD-3-Clause
// The fast operator: blocks, threads, choice of instruction set; in double and in single precision.
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
  /// "avx512", "avx2", "plain"; empty: what KACANOV_INSTRUCTION_SET says, else the best there is
  std::string_view instruction_set;
  /// Nodes whose values are wanted first, as those that other processes have too; see WhenEarly.
  std::span<const std::int32_t> early = {};
};

/// What to do once y holds its final values at the early nodes, before the rest of it is worked out: they can
/// be on their way while that goes on. Called on the calling thread; it may change y there. With or without
/// it y has the same bits.
using WhenEarly = std::function<void()>;

/// y = B(g) x and what a solver needs round it (theory: operator), in the precision of `Real`. The body's
/// arrays are copied as far as needed: they may go once the constructor is done.
///
/// Vectors have nodes × dim entries, interleaved, in the caller's numbering; any numbering will do, that of
/// locality_order() is the fastest. Displacements have the caller's unit of length, moduli and stresses one
/// unit, forces that times an area (a length in 2D, for unit thickness). g has elements × points entries in
/// the caller's order of elements, always in double precision outside.
///
/// Results are the same bits in every run with the same threads and instruction set. Members that are not
/// const share scratch memory: one call at a time. Members throw std::invalid_argument where a length is
/// wrong, the constructor also for whatever else is wrong with the body or the options.
///
/// In single precision coordinates are kept relative to the middle of each block; relative error about 1e-6
/// on well-shaped elements. Sums (xᵀ y, energies) are in double precision all the same.
template <class Real>
class BasicOperator {
 public:
  explicit BasicOperator(const Body& body, const OperatorOptions& options = {});
  /// Divides the mesh as `like` does, which has to be of the same mesh with the same law_of_element; the laws
  /// themselves may be others, and so may the options. Takes a fifth of the time. `like` may go afterwards.
  BasicOperator(const Body& body, const OperatorOptions& options, const BasicOperator<double>& like);
  ~BasicOperator();
  BasicOperator(BasicOperator&&) noexcept;
  BasicOperator& operator=(BasicOperator&&) noexcept;

  std::size_t unknowns() const noexcept;

  /// Where tr ε is averaged round corners (CornerMeans) that other processes have elements at, too: `sum`
  /// adds up what they all have for each entry of corner_means() of this body. It is called at once, and then
  /// by every product, residual and energy, so that these are collective; an empty one takes it back.
  void set_corner_sum(std::function<void(std::span<Real>)> sum);
  /// Plane stress: as Body::free_strain, elements; what follows of a displacement knows of it, B(g) and B_T
  /// stay what they are. Empty: none, as to begin with. Throws std::logic_error in other bodies.
  void set_free_strain(std::span<const double> of_element);
  /// Freezes g at the displacement u. It starts as g = μ.
  void update(std::span<const Real> u);
  /// The frozen g into `g`, rounded to Real.
  void secant(std::span<double> g) const;
  void set_secant(std::span<const double> g);
  /// y = B(g) x (overwrites y).
  void apply(std::span<const Real> x, std::span<Real> y, const WhenEarly& when_early = {});
  /// y = B(g) x and returns xᵀ y (as it is without what `when_early` changes).
  double apply_dot(std::span<const Real> x, std::span<Real> y, const WhenEarly& when_early = {});
  /// y_v = B(g) x_v for `vectors` ≥ 1 input vectors, stored one after another; the geometry is worked out
  /// once for up to four of them.
  void apply_many(std::span<const Real> x, std::span<Real> y, int vectors);
  /// Diagonal of B(g), nodes × dim; where tr ε is averaged round corners, that of its values at the points,
  /// which is no less.
  void diagonal(std::span<Real> d) const;
  /// Diagonal blocks of B(g), nodes × dim × dim, each block row-major; likewise. `wanted`: a flag a node, or
  /// none for all of them; blocks of nodes without it may lack elements.
  void block_diagonal(std::span<Real> blocks, std::span<const char> wanted = {}) const;

  // B(g) = A + Bᵀ C⁻¹ B where tr ε is averaged round corners, C their volumes over k0 (theory:
  // displacement-pressure): its parts, for preconditioners. p and q have an entry for each of corner_means()
  // of this body, p a stress, q a volume. Throw std::logic_error where nothing is averaged.

  /// Entries of p; 0 where nothing is averaged.
  std::size_t pressures() const noexcept;
  /// y = A x + Bᵀ p; without p, A x.
  void apply_deviator(std::span<const Real> x, std::span<const Real> p, std::span<Real> y,
                      const WhenEarly& when_early = {});
  /// y = Bᵀ p.
  void pressure_force(std::span<const Real> p, std::span<Real> y, const WhenEarly& when_early = {});
  /// q = B x, this process's share.
  void volume_change(std::span<const Real> x, std::span<Real> q);
  /// Diagonal blocks of A, as block_diagonal.
  void block_diagonal_deviator(std::span<Real> blocks, std::span<const char> wanted = {}) const;

  /// Freezes the tangent (and g) at u for apply_tangent.
  void update_tangent(std::span<const Real> u);
  /// y = B_T x with the tangent frozen last, whatever became of g since. The direction of dev ε in its
  /// rank-one term is kept in single precision (relative error 1e-7 of that term). Throws std::logic_error
  /// before the first update_tangent.
  void apply_tangent(std::span<const Real> x, std::span<Real> y, const WhenEarly& when_early = {});
  /// y = B_T x and returns xᵀ y, as apply_dot.
  double apply_tangent_dot(std::span<const Real> x, std::span<Real> y, const WhenEarly& when_early = {});
  /// As apply_many.
  void apply_tangent_many(std::span<const Real> x, std::span<Real> y, int vectors);
  /// Diagonal and diagonal blocks of B_T, as those of B(g). Throw std::logic_error before update_tangent.
  void diagonal_tangent(std::span<Real> d) const;
  void block_diagonal_tangent(std::span<Real> blocks) const;
  /// Takes over the tangent that `from` froze last, of the same body; this g stays. Throws std::logic_error
  /// where it has none.
  void take_tangent(const BasicOperator<double>& from);
  /// Gives the tangent's memory back, 20 bytes an element point. What needs the tangent throws until the next
  /// update_tangent.
  void forget_tangent() noexcept;

  /// Internal force of the true law at u into f; the frozen g plays no part.
  void residual(std::span<const Real> u, std::span<Real> f);
  /// Stored energy of the true law at u (theory: energy).
  double energy(std::span<const Real> u);
  /// Residual, energy and new g in one pass; returns the energy.
  double residual_energy_update(std::span<const Real> u, std::span<Real> f);

  // A law of the caller's own: he works out what it says from strain(), and the following take that in place
  // of what the body's laws say, which leave their k0; g goes to set_secant().

  /// ‖dev ε‖ at every point, elements × points, into `x`; g plays no part.
  void strain(std::span<const Real> u, std::span<double> x);
  /// Freezes the tangent, and g, of these moduli at u. Needs `derivative`.
  void update_tangent(std::span<const Real> u, const PointModuli& moduli);
  /// Internal force at u into f, unless that is empty; the frozen g plays no part. Returns the energy, 0
  /// where there is no `energy`.
  double residual_energy(std::span<const Real> u, const PointModuli& moduli, std::span<Real> f);

  /// "avx512", "avx2" or "plain": what the loops in use are built for.
  std::string_view instruction_set() const noexcept;
  /// Bytes this operator holds, index data included.
  std::size_t bytes() const noexcept;
  /// How often B was applied (secant and tangent, to one vector each) since construction.
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
/// For preconditioners, and solvers of mixed precision.
using FloatOperator = BasicOperator<float>;

}  // namespace kacanov
