// SPDX-License-Identifier: BSD-3-Clause
// Transfer between points (nodes or rows of a finer grid) and the trilinear functions on a tree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>
#include "multigrid/grid_vertices.hpp"

namespace kacanov {

/// Interpolates values of rows, on any rank, at this rank's points, and restricts by the transpose.
class GridTransfer {
 public:
  /// A point in a leaf.
  struct Place {
    std::int32_t leaf;
    Vector3 within;
  };
  /// The arguments need not outlive it. Collective.
  GridTransfer(const GridVertices& vertices, std::vector<Place> points, const Communicator& comm,
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

}  // namespace kacanov
