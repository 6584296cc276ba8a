// SPDX-License-Identifier: BSD-3-Clause
// What an operator holds, and the passes of its threads over its blocks: every thread its share, private sums
// where threads meet, always in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/operator.hpp>
#include "operator/aligned.hpp"
#include "operator/corners.hpp"
#include "operator/layout.hpp"
#include "simd/instruction_set.hpp"

namespace kacanov {

/// Vectors are nodes × dim in the caller's numbering. Nothing is checked here: see checks.hpp and
/// operator.cpp.
template <class Real>
struct BasicOperator<Real>::Data {
  struct Scratch {
    Aligned<Real> u, f;      ///< records of the block at hand, for up to four input vectors
    std::vector<Real> sums;  ///< private sums on the interface, three values a slot
  };

  /// `like`: how an operator in double of the same mesh has divided it; null: afresh.
  Data(const Body& body, const OperatorOptions& options, const Layout* like);
  // The views of the laws point into it.
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  std::size_t dim() const { return dimension(type); }
  /// The bulk modulus that strains within the plane meet.
  double bulk_at(const Law& law, double g) const;
  simd::Block<Real> block(std::size_t b);
  void reserve_scratch(int count);
  /// To be called before g changes: the tangent frozen last keeps the g it was frozen with.
  void detach_tangent();

  /// y_v = B x_v for `count` vectors (1, 2 or 4), one after another in x and y. Returns Σ x_vᵀ y_v if
  /// `with_dot`, else 0.
  double apply(const Real* x, Real* y, int count, bool with_dot, const WhenEarly& when_early = {});
  double apply_tangent(const Real* x, Real* y, int count, bool with_dot, const WhenEarly& when_early = {});
  /// Σ x_vᵀ y_v over the block.
  double dots(const simd::Block<Real>& at, const simd::Vectors<Real>& vectors);
  /// Internal force at u into f, unless that is null; what to keep. Returns the energy if that is summed.
  double nonlinear(const Real* u, Real* f, simd::Nonlinear keep, const simd::Outside<Real>& outside = {});
  /// Of the caller's elements × points: as the slots have them, 0 in idle lanes; null where there are none.
  const Real* by_slot(std::span<const double> values, Aligned<Real>& slots) const;

  /// Whether this or another process averages tr ε around corners. Decides what all processes take part in,
  /// in place of the entries here.
  bool averages() const { return corners.entries > 0 || sum_corners; }
  /// change = ∫ N tr ε(x_v) round the corners, this process's share, in the places of the entries.
  void find_changes(const Real* x, int count);
  /// y = A x (theory: displacement-pressure).
  void apply_deviator(const Real* x, Real* y, const WhenEarly& when_early);
  /// y = A x + Bᵀ p, or Bᵀ p where x is null (theory: displacement-pressure).
  void apply_pressure(const Real* x, const Real* p, Real* y, const WhenEarly& when_early);
  /// Means of tr ε(x_v) round the corners, from here and from other processes, into `mean`. Returns the
  /// energy that k0 stores in those of the first vector, this process's share.
  double find_means(const Real* x, int count);
  /// Works out `weight`, with what other processes have.
  void weigh_corners();

  /// Calls loops(block, u, f, stride) between gathering x and scattering y, and adds up what it returns.
  /// `averaged`: find_means() has found those of x. Where x is null the records of u hold means alone.
  template <class LoopsOnBlock>
  double pass(const Real* x, Real* y, int count, bool averaged, const WhenEarly& when_early,
              LoopsOnBlock&& loops);
  void add_interface(Real* y, int count, std::size_t begin, std::size_t end);

  template <class E, class Visit>
  void visit_elements(const BlockRange& range, const simd::Group& group, std::span<const char> wanted,
                      const Visit& visit) const;
  template <class Add>
  void sum_blocks(std::span<Real> blocks, std::span<const char> wanted, const Add& add) const;
  template <class Bulk>
  void sum_secant_blocks(std::span<Real> blocks, std::span<const char> wanted, const Bulk& bulk) const;

  simd::InstructionSet set;
  const simd::Kernels<Real>& kernels;
  ElementType type;
  PlaneState plane;
  int threads;
  std::size_t unknowns, points;
  std::vector<Law> laws;
  std::vector<simd::LawView> views;
  Layout layout;
  Aligned<Real> coordinates;
  Aligned<Real> secant;  ///< by slot
  bool has_tangent = false;
  Aligned<float> tangent;
  Aligned<Real> tangent_secant;  ///< g of the tangent, where it is no longer `secant`
  Aligned<Real> free_strain;     ///< by slot; empty: none
  Aligned<Real> strain, outside_secant, outside_slope, outside_energy;  ///< empty until they are asked for
  CornerLayout corners;
  std::vector<double> corner_bulk, corner_volume;  ///< of the entries; volumes of this process
  std::vector<Real> weight, change, mean;  ///< of the entries (or places): 1 over all volume; by vector
  std::function<void(std::span<Real>)> sum_corners;  ///< over processes; null: there is one
  std::vector<Scratch> scratch;
  int scratch_vectors = 0;
  std::uint64_t applications = 0;
};

}  // namespace kacanov
