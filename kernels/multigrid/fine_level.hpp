// SPDX-License-Identifier: BSD-3-Clause
// The fine level of the multigrid: B(g) and node blocks in single precision, with block Jacobi.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/scatterer.hpp>
#include "multigrid/cycle.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/pressure_rows.hpp"

namespace kacanov {

struct MultigridOptions;

/// The part of B(g) in a fine level: all of it, or A, without k0 where tr ε is averaged (theory:
/// displacement-pressure).
enum class FinePart { whole, deviator };

/// A = B(g) + blocks on free components, matrix-free in single precision. Directions that the setup's space
/// holds are held by stiff blocks here, so that the smoother stays definite in the spaces of later solves;
/// coarse corrections are projected. Vectors have the body's unknowns and are consistent; blocks belong to
/// owned nodes; g has elements × points entries, stresses. setup, update, multiply, project and
/// choose_smoother are collective.
class FineLevel {
 public:
  /// g = μ and no blocks until setup(). The arrays that the body points to must outlive it. `means`: those of
  /// the body's PressureRows; may be null except for the deviator of elements that average over themselves.
  FineLevel(const MultigridBody& body, const MultigridOptions& options, FinePart part = FinePart::whole,
            const CornerMeans* means = nullptr);
  /// Freezes g, copies the blocks and the space, and computes D.
  void setup(std::span<const double> g, const NodeSupports& supports);
  /// Keeps g and the held components of the last setup; updates D at nodes that have or had blocks. Returns
  /// the previous blocks and space.
  std::pair<std::vector<NodeBlock>, ConstrainedSpace> update(const NodeSupports& supports);
  /// Inputs of the last setup or update.
  std::span<const NodeBlock> blocks() const noexcept { return blocks_; }
  const ConstrainedSpace& space() const noexcept { return space_; }
  /// g as stored, in single precision.
  void secant(std::span<double> g) const { op_.secant(g); }
  /// y = A x for x that is zero in held components.
  void multiply(std::span<const float> x, std::span<float> y);
  /// The step of Chebyshev::smooth, with D the dim × dim diagonal blocks of A.
  void relax(const ChebyshevStep<float>& weights, std::span<const float> b, std::span<const float> image,
             std::span<float> step, std::span<float> x) const;
  /// Chebyshev smoothing with choose_smoother()'s polynomial; from zero if asked. Collective.
  void smooth(bool from_zero, const SmootherVectors<float>& on);
  /// r = b − A x − Bᵀ p, projected; without p if it is empty. Collective.
  void residual(std::span<const float> b, std::span<const float> x, std::span<const float> p,
                std::span<float> r);
  /// Completes and projects the correction u of the owned nodes, and adds it to x. Collective.
  void add_correction(std::span<float> u, std::span<float> x) const;
  /// b = factor r, zero in held components.
  void load(double factor, std::span<const double> r, std::span<float> b) const;
  /// z = factor x.
  void store(double factor, std::span<const float> x, std::span<double> z) const;
  /// x += factor D⁻¹ (b − image), or, without an image, x += factor D⁻¹ b.
  void add_scaled(float factor, std::span<const float> b, std::span<const float> image,
                  std::span<float> x) const;
  /// y = A x + Bᵀ p with A of the deviator; p has one entry per average. Collective.
  void multiply(std::span<const float> x, std::span<const float> p, std::span<float> y);
  /// y = Bᵀ p. Collective.
  void pressure_force(std::span<const float> p, std::span<float> y);
  /// q = B x, the contribution of this rank.
  void volume_change(std::span<const float> x, std::span<float> q);
  /// D⁻¹, nodes × 6: the upper triangles of the inverse blocks, by rows; nodes × 3 in 2D.
  std::span<const float> inverse() const noexcept { return inverse_; }
  /// D's diagonal at held components, where the blocks keep their entries.
  std::span<const float> held_stiffness() const noexcept { return held_stiffness_; }
  /// Average diagonal entry of each node's block, without added blocks.
  std::span<const float> own_stiffness() const noexcept { return own_stiffness_; }
  std::span<const std::int32_t> held() const noexcept { return held_; }
  /// Λ, the largest eigenvalue of D⁻¹A, from choose_smoother().
  double largest() const noexcept { return smoother_.upper; }
  /// Sets held components to zero.
  void hold(std::span<float> x) const;
  /// Projects onto the space of the setup.
  void project(std::span<float> x) const;
  /// Estimates the largest eigenvalue Λ of D⁻¹A for a polynomial of this degree on [Λ/range, Λ] (theory:
  /// chebyshev). It remains valid for later blocks: they are part of both D and A, and move their share of Λ
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
  void take_supports(const NodeSupports& supports);
  void take_own_stiffness(std::span<const float> blocks);
  void take_diagonal(std::span<float> blocks, std::span<const char> renewed);
  void add_blocks(std::span<const NodeBlock> blocks, std::span<const float> x, std::span<float> y) const;

  MultigridBody body_;
  int threads_;
  FinePart part_;
  std::vector<Law> laws_;  ///< if elements average over themselves: laws without the part with pressures
  std::optional<ElementChanges> of_elements_;  ///< B of these elements, which the operator does not provide
  FloatOperator op_;
  Scatterer<float> sum_;
  std::vector<std::int32_t> held_;  ///< components
  std::vector<float> held_stiffness_, own_stiffness_;
  ConstrainedSpace space_;
  std::vector<NodeBlock> blocks_;
  std::size_t shared_blocks_ = 0;  ///< number of leading blocks of nodes shared with other ranks
  std::vector<float> inverse_;  ///< nodes × 6 (3 in 2D): the upper triangles of the inverse blocks, by rows
  Chebyshev smoother_;
};

}  // namespace kacanov
