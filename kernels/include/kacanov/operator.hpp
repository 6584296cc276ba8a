// SPDX-License-Identifier: BSD-3-Clause
// The fast operator: blocks, threads, choice of instruction set.
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

/// y = B(g) x and what a solver needs round it. The body's arrays are copied as far as needed:
/// they may go once the constructor is done. Vectors are nodes × dim, interleaved, in the caller's
/// numbering; any numbering will do, that of locality_order() is the fastest. Results are the same bits in
/// every run with the same threads and instruction set. One call at a time: members share scratch memory.
/// Throws std::invalid_argument on bad input.
class Operator {
 public:
  explicit Operator(const Body& body, const OperatorOptions& options = {});
  ~Operator();
  Operator(Operator&&) noexcept;
  Operator& operator=(Operator&&) noexcept;

  std::size_t unknowns() const noexcept;
  /// Freezes g at ω. Starts as g = mu.
  void update(std::span<const double> omega);
  /// Frozen g: elements × points, the caller's element order.
  void secant(std::span<double> g) const;
  void set_secant(std::span<const double> g);
  /// y = B(g) x (overwrites y).
  void apply(std::span<const double> x, std::span<double> y) const;
  /// y = B(g) x and returns xᵀ y (as it is without what `when_early` changes).
  double apply_dot(std::span<const double> x, std::span<double> y, const WhenEarly& when_early = {}) const;
  /// y_v = B(g) x_v for `vectors` ≥ 1 right sides, stored one after another; the geometry is worked out once
  /// for up to four of them.
  void apply_many(std::span<const double> x, std::span<double> y, int vectors) const;
  /// Freezes the tangent (and g) at ω for apply_tangent.
  void update_tangent(std::span<const double> omega);
  /// y = B_T x with the tangent frozen last, whatever became of g since. The direction of dev ε in its
  /// rank-one term is kept in single precision (relative error 1e-7 of that term). Throws std::logic_error
  /// before the first update_tangent.
  void apply_tangent(std::span<const double> x, std::span<double> y) const;
  /// y = B_T x and returns xᵀ y, as apply_dot.
  double apply_tangent_dot(std::span<const double> x, std::span<double> y,
                           const WhenEarly& when_early = {}) const;
  /// Gives the tangent's memory back, 20 bytes an element point. apply_tangent throws until the next
  /// update_tangent.
  void forget_tangent() noexcept;
  void diagonal(std::span<double> d) const;
  void block_diagonal(std::span<double> blocks) const;
  /// Internal force of the true law at ω.
  void residual(std::span<const double> omega, std::span<double> f) const;
  double energy(std::span<const double> omega) const;
  /// Residual, energy and new g in one pass; returns the energy.
  double residual_energy_update(std::span<const double> omega, std::span<double> f);

  std::string_view instruction_set() const noexcept;
  /// Bytes this operator holds, index data included.
  std::size_t bytes() const noexcept;
  /// How often B was applied (secant and tangent) since construction.
  std::uint64_t applications() const noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kacanov
