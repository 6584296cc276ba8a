// SPDX-License-Identifier: BSD-3-Clause
// The fine level of the multigrid: B(g) and node blocks in single precision, with its block diagonal.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/scatterer.hpp>
#include "multigrid/chebyshev.hpp"
#include "multigrid/element_pressures.hpp"
#include "multigrid/held_space.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/node_block.hpp"

namespace kacanov {

struct MultigridOptions;

/// What of B(g) a fine level is of: all of it, or A, without k0 where tr ε is averaged (theory:
/// displacement-pressure).
enum class FinePart { whole, deviator };

/// A = B(g) + blocks on free components, in single precision, never stored. Directions that the space of the
/// setup holds are held by stiff blocks here, so that the smoother stays definite in the spaces of later
/// solves; corrections from below are projected. Vectors have the body's unknowns and are consistent;
/// blocks are of owned nodes, g has elements × points, stresses. build, rebuild, multiply, project and
/// choose_smoother are collective.
class FineLevel {
 public:
  /// g = μ and no blocks until build(). What the body points to has to outlive it. `means`: those of the
  /// body's PressureRows; null if it is not the deviator of elements that average over themselves.
  FineLevel(const MultigridBody& body, const MultigridOptions& options, FinePart part = FinePart::whole,
            const CornerMeans* means = nullptr);
  /// Freezes g and takes the blocks and the space over; D follows.
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space);
  /// With the g and the held components of the last build: D changes where there are blocks, or were some.
  void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space);
  /// What it was built with.
  std::span<const NodeBlock> blocks() const noexcept { return blocks_; }
  const HeldSpace& space() const noexcept { return space_; }
  /// g as it is held: in single precision.
  void secant(std::span<double> g) const { op_.secant(g); }
  /// y = A x for x that is zero in held components.
  void multiply(std::span<const float> x, std::span<float> y);
  /// Chebyshev::smooth's step, with D the dim × dim diagonal blocks of A.
  void relax(const ChebyshevStep<float>& weights, std::span<const float> b, std::span<const float> image,
             std::span<float> step, std::span<float> x) const;
  /// x += factor D⁻¹ (b − image), without an image x += factor D⁻¹ b.
  void add_scaled(float factor, std::span<const float> b, std::span<const float> image,
                  std::span<float> x) const;
  /// y = A x + Bᵀ p of the deviator's A; p has an entry for each of the means. Collective.
  void multiply(std::span<const float> x, std::span<const float> p, std::span<float> y);
  /// y = Bᵀ p. Collective.
  void pressure_force(std::span<const float> p, std::span<float> y);
  /// q = B x, this rank's share.
  void volume_change(std::span<const float> x, std::span<float> q);
  /// D⁻¹, nodes × 6: the upper triangles of the inverse blocks, by rows; 3 in 2D.
  std::span<const float> inverse() const noexcept { return inverse_; }
  /// Of held components, which keep their blocks' entries: D's diagonal.
  std::span<const float> held_stiffness() const noexcept { return held_stiffness_; }
  /// Of every node, the mean of its block's diagonal without what is added.
  std::span<const float> own_stiffness() const noexcept { return own_stiffness_; }
  std::span<const std::int32_t> held() const noexcept { return held_; }
  /// Λ, of D⁻¹A; choose_smoother has worked it out.
  double largest() const noexcept { return smoother_.upper; }
  /// Zero in held components.
  void hold(std::span<float> x) const;
  /// Onto the space of the setup.
  void project(std::span<float> x) const;
  /// Estimates the largest eigenvalue of D⁻¹A for a polynomial of this degree on [Λ/range, Λ] (theory:
  /// chebyshev). It serves for later blocks as well: they are part of both D and A, and take their share of Λ
  /// towards 1.
  void choose_smoother(int degree, double range);
  const Chebyshev& smoother() const noexcept { return smoother_; }
  std::size_t bytes() const noexcept {
    return op_.bytes() + (of_elements_ ? of_elements_->bytes() : 0) + held_.size() * sizeof(std::int32_t) +
           blocks_.size() * sizeof(NodeBlock) +
           (inverse_.size() + held_stiffness_.size() + own_stiffness_.size()) * sizeof(float);
  }

 private:
  template <class Apply>
  void product(const Apply& apply, std::span<const float> x, std::span<float> y);
  std::vector<float> node_blocks(std::span<const char> wanted) const;
  std::vector<char> touched_by(std::span<const NodeBlock> blocks) const;
  void take_blocks(std::span<const NodeBlock> blocks, const HeldSpace& space);
  void take_own_stiffness(std::span<const float> blocks);
  void take_diagonal(std::span<float> blocks, std::span<const char> renewed);
  void add_blocks(std::span<const NodeBlock> blocks, std::span<const float> x, std::span<float> y) const;

  MultigridBody body_;
  int threads_;
  FinePart part_;
  std::vector<Law> laws_;  ///< where elements average over themselves: the body's without what has pressures
  std::optional<ElementChanges> of_elements_;  ///< B of these, which the operator does not have by itself
  FloatOperator op_;
  Scatterer<float> sum_;
  std::vector<std::int32_t> held_;  ///< components
  std::vector<float> held_stiffness_, own_stiffness_;
  HeldSpace space_;
  std::vector<NodeBlock> blocks_;
  std::size_t shared_blocks_ = 0;  ///< the first of them belong to nodes that other ranks have too
  std::vector<float> inverse_;  ///< nodes × 6 (3 in 2D): the upper triangles of the inverse blocks, by rows
  Chebyshev smoother_;
};

}  // namespace kacanov
