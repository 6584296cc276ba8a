// SPDX-License-Identifier: BSD-3-Clause
// One level of displacements and pressures on an octree: matrix, smoother, and transfer to nodes and finer
// levels.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/scatterer.hpp>
#include "multigrid/cycle.hpp"
#include "multigrid/octree/cell_stiffness.hpp"
#include "multigrid/octree/octree.hpp"
#include "multigrid/sparsity_pattern.hpp"
#include "simd/node_blocks.hpp"

namespace kacanov {

/// Interpolates values of rows, on any rank, at this rank's points, and restricts by the transpose.
class OctreeTransfer {
 public:
  /// A point in a leaf.
  struct Place {
    std::int32_t leaf;
    Vector3 within;
  };
  /// The arguments need not outlive it. Collective.
  OctreeTransfer(const OctreeVertices& vertices, std::vector<Place> points, const Communicator& comm,
                 int threads);

  /// Adds interpolated values to x, `count` per point. `rows`: this rank's rows with `stride` values each, of
  /// which the first `count` are used from the beginning of the span on. Collective.
  template <class Real>
  void prolong(std::span<const float> rows, std::size_t stride, std::size_t count, std::span<Real> x);
  /// rows = the transpose applied to x; other values of the rows are unchanged. Collective.
  template <class Real>
  void restrict_to(std::span<const Real> x, std::size_t count, std::span<float> rows, std::size_t stride);

  std::size_t bytes() const noexcept;

 private:
  struct Share {
    std::int32_t row;  ///< local: this rank's rows, then others'
    float weight;
  };
  std::span<const Share> shares(std::size_t corner) const {
    return std::span(shares_).subspan(first_share_[corner], first_share_[corner + 1] - first_share_[corner]);
  }
  int threads_;
  std::unique_ptr<const IndexMap> map_;   ///< of the rows that these points need
  std::vector<std::size_t> first_share_;  ///< size leaves × 8 + 1
  std::vector<Share> shares_;
  std::vector<std::size_t> first_point_;  ///< size leaves + 1
  std::vector<std::int32_t> point_;       ///< sorted by leaf
  std::vector<std::array<float, 3>> within_;
  std::vector<float> local_, corner_;  ///< scratch: values of local rows and of the leaves' corners
};

/// Values per row in a grid's vectors: a displacement and a pressure, or a force and a volume change.
inline constexpr std::size_t grid_width = 4;

/// K = [A Bᵀ; B −C] over the rows of a grid, distributed by rows, with the inexact Braess–Sarazin smoother
/// (theory: pressure-smoothing). Vectors have four values per row; those to be multiplied also have room for
/// ghosts of map().
class OctreeLevel {
 public:
  /// Builds the sparsity pattern. `leaves`: of the level of the vertices. Collective.
  OctreeLevel(const OctreeVertices& vertices, const OctreeLeaves& leaves, const Communicator& comm,
              int threads);
  /// Builds the matrix. Collective.
  void setup(const Octree& tree, const OctreeLeaves& leaves, const LevelMoments& moments);
  /// Replaces only the stiffnesses of nodes. Collective.
  void update(const Octree& tree, const OctreeLeaves& leaves, const LevelStiffness& stiffness);

  std::size_t rows() const noexcept { return pattern_->owned_rows(); }
  const IndexMap& map() const noexcept { return pattern_->columns(); }

  /// Smoothing steps on x for the input b; on the way down of a cycle they start from zero. Collective.
  void smooth(bool down, const PressureSteps& with, std::span<const float> b, std::vector<float>& x);
  /// r = b − K x on owned rows. Collective.
  void residual(std::span<const float> b, std::vector<float>& x, std::span<float> r);
  std::size_t bytes() const noexcept;

 private:
  struct Share {
    std::int32_t row, column;
    float weight;
  };
  std::span<const Share> shares_of(std::size_t leaf) const {
    return std::span(shares_).subspan(first_[8 * leaf], first_[8 * leaf + 8] - first_[8 * leaf]);
  }
  template <class FormOf>
  void add_forms(std::size_t leaves, const FormOf& form_of);
  void add(const CellStiffness& form, std::size_t leaf, std::int32_t begin, std::int32_t end);
  void keep_rows(const LevelStiffness& stiffness);
  void invert_diagonal();
  void find_scales();
  void fill(std::span<float> x) { fill_->start_forward(x), fill_->finish_forward(x); }
  simd::GridRow row(std::size_t i) const {
    const auto start = pattern_->start();
    return {pattern_->column().data(), static_cast<std::size_t>(start[i]),
            static_cast<std::size_t>(start[i + 1])};
  }
  template <class Work>
  void each_row(const Work& work) const {
    each_in_shares(threads_, rows(), work);
  }
  /// y = Â⁻¹Bᵀp with −C p in the fourth lane, on owned rows; fills p's ghosts.
  void lift(std::span<float> p, std::span<float> y);
  /// q = S p.
  void schur(std::span<float> p, std::span<float> q);

  int threads_;
  std::optional<SparsityPattern> pattern_;
  std::vector<std::size_t> first_;  ///< size leaves × 8 + 1, index into shares_
  std::vector<Share> shares_;       ///< rows and weights of the leaves' corners
  /// Per entry: the three columns of A with B's entries below, Bᵀ's column with −C's entry below, and B's
  /// entries again.
  std::vector<float> force_, pressure_, divergence_;
  /// Rows of A that stiffnesses change, and their values without stiffnesses.
  std::vector<std::int32_t> kept_row_;
  std::vector<float> kept_;
  std::vector<float> inverse_;        ///< of Â: local rows × three columns of four values
  std::vector<float> schur_inverse_;  ///< inverse of S's diagonal
  PressureSolve solve_;
  std::optional<Scatterer<float>> fill_, fill_p_;
  std::vector<float> p_, lifted_, moved_;  ///< scratch
};

}  // namespace kacanov
