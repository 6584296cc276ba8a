// SPDX-License-Identifier: BSD-3-Clause
// The way between points, be they nodes or rows of a finer grid, and the trilinear functions on a tree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>
#include "multigrid/grid_vertices.hpp"

namespace kacanov {

/// Values of this rank's points by those of rows, wherever these live, and the transpose of that.
class GridTransfer {
 public:
  /// A point in a leaf.
  struct Place {
    std::int32_t leaf;
    Vector3 within;
  };
  /// What is passed may go afterwards. Collective.
  GridTransfer(const GridVertices& vertices, std::vector<Place> points, const Communicator& comm,
               int threads);

  /// Adds values there to x, `count` a point: of the rows, `stride` values each, those from the first on that
  /// the span begins with. `rows` has this rank's. Collective.
  template <class Real>
  void prolong(std::span<const float> rows, std::size_t stride, std::size_t count, std::span<Real> x);
  /// rows = the transpose of that; other values of the rows stay. Collective.
  template <class Real>
  void restrict_to(std::span<const Real> x, std::size_t count, std::span<float> rows, std::size_t stride);

  std::size_t bytes() const noexcept;

 private:
  struct Share {
    std::int32_t row;  ///< local: this rank's, then others'
    float weight;
  };
  std::span<const Share> shares(std::size_t corner) const {
    return std::span(shares_).subspan(first_share_[corner], first_share_[corner + 1] - first_share_[corner]);
  }
  int threads_;
  std::unique_ptr<const IndexMap> map_;   ///< of the rows that the points here need
  std::vector<std::size_t> first_share_;  ///< leaves × 8 + 1
  std::vector<Share> shares_;
  std::vector<std::size_t> first_point_;  ///< leaves + 1
  std::vector<std::int32_t> point_;       ///< leaf by leaf
  std::vector<std::array<float, 3>> within_;
  std::vector<float> local_, corner_;  ///< scratch: values of local rows, of the leaves' corners
};

}  // namespace kacanov
