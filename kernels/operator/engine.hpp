// SPDX-License-Identifier: BSD-3-Clause
// The operator in one precision: its layout, its values, and the passes of its threads over them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/operator.hpp>
#include "operator/aligned.hpp"
#include "operator/layout.hpp"
#include "simd/instruction_set.hpp"

namespace kacanov {

/// Vectors are nodes × dim in the caller's numbering. Nothing is checked here: see check_body and
/// operator.cpp.
template <class Real>
class Engine {
 public:
  Engine(const Body& body, int threads, simd::InstructionSet set, std::span<const std::int32_t> early);
  // The views of the laws point into the engine.
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  std::size_t unknowns() const noexcept { return unknowns_; }
  std::size_t points() const noexcept { return points_; }
  std::size_t bytes() const noexcept;
  simd::InstructionSet instruction_set() const noexcept { return set_; }
  bool has_tangent() const noexcept { return !tangent_.empty(); }
  void forget_tangent() noexcept;
  std::size_t dim() const noexcept { return static_cast<std::size_t>(dim_); }

  void get_secant(std::span<double> g) const;
  void set_secant(std::span<const double> g);
  /// y_v = B x_v for `vectors` right sides (1, 2 or 4), one after another in x and y. Returns Σ x_vᵀ y_v if
  /// `with_dot`, else 0. `when_early` as in Operator.
  double apply(const Real* x, Real* y, int vectors, bool with_dot, const WhenEarly& when_early = {}) const;
  /// Any number of right sides, which are checked. Throws std::invalid_argument.
  void apply_many(std::span<const Real> x, std::span<Real> y, int vectors) const;
  double apply_tangent(const Real* x, Real* y, bool with_dot, const WhenEarly& when_early = {}) const;
  /// Internal force at ω into f, unless that is null; what to keep. Returns the energy if that is to be
  /// summed.
  double nonlinear(const Real* omega, Real* f, simd::Nonlinear keep);
  double nonlinear(const Real* omega, Real* f, bool sum_energy) const;
  /// dim × dim diagonal blocks of B, row-major.
  void block_diagonal(std::span<Real> blocks) const;
  void diagonal(std::span<Real> d) const;

 private:
  struct Scratch {
    Aligned<Real> u, f;      ///< records of the block at hand, for up to four right sides
    std::vector<Real> sums;  ///< private sums on the interface, three values a slot
  };

  void reserve_scratch(int vectors) const;
  simd::Block<Real> block(std::size_t b) const;
  /// To be called before g changes: the tangent frozen last keeps the g it was frozen with.
  void detach_tangent();
  double pass_nonlinear(const Real* omega, Real* f, simd::Nonlinear keep) const;
  /// Calls loops(block, scratch) between gathering x and scattering y, and adds up what it returns.
  template <class LoopsOnBlock>
  double pass(const Real* x, Real* y, int vectors, const WhenEarly& when_early, LoopsOnBlock&& loops) const;
  template <class E>
  void add_diagonals(const BlockRange& range, const simd::Group& group, std::span<Real> blocks) const;
  void add_interface(Real* y, int vectors, std::size_t begin, std::size_t end) const;

  simd::InstructionSet set_;
  const simd::Kernels<Real>& kernels_;
  ElementType type_;
  int dim_, threads_;
  std::size_t unknowns_, points_;
  std::vector<Law> laws_;
  std::vector<simd::LawView> views_;
  Layout layout_;
  Aligned<Real> coordinates_;
  mutable Aligned<Real> secant_;  ///< by slot; the nonlinear pass writes it on request only
  mutable Aligned<float> tangent_;
  Aligned<Real> tangent_secant_;  ///< g of the tangent, where it is no longer `secant_`
  mutable std::vector<Scratch> scratch_;
  mutable int scratch_vectors_ = 0;
};

}  // namespace kacanov
