// SPDX-License-Identifier: BSD-3-Clause
// Octree around the nodes of a body, whose trilinear functions form a coarse space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/communicator.hpp>
#include <kacanov/vector3.hpp>

namespace kacanov {

/// An octree, the same on every rank: cubes are split until their edge is `ratio` times the node spacing in
/// them; cubes without nodes are omitted. A position is a point of the lattice of the deepest possible cubes
/// (theory: background-grid).
class GridTree {
 public:
  using Position = std::array<std::int32_t, 3>;
  static constexpr int deepest = 20;
  static constexpr std::int32_t side = 1 << deepest;

  struct Cell {
    Position origin{};
    std::int32_t parent = -1, depth = 0, owner = 0;  ///< owner: the rank with most of the cell's nodes
    std::array<std::int32_t, 8> child{-1, -1, -1, -1, -1, -1, -1, -1};
    std::int32_t height = 0;  ///< number of levels of cells below

    std::int32_t size() const { return side >> depth; }
  };
  /// Nodes: coordinates, × 3, and distance between neighbours around each node; the first `owned` belong to
  /// this rank.
  struct Nodes {
    std::span<const double> coordinates, spacing;
    std::size_t owned = 0;
  };

  /// Collective.
  GridTree(const Nodes& nodes, double ratio, const Communicator& comm);

  std::span<const Cell> cells() const noexcept { return cells_; }
  /// On each next level, cells whose children are all leaves become leaves; on the last level the root is a
  /// leaf.
  int last_level() const noexcept { return cells_.front().height; }
  bool is_leaf(std::int32_t cell, int level) const {
    const Cell& c = cells_[cell];
    return c.height <= level && (c.parent < 0 || cells_[c.parent].height > level);
  }
  /// The leaf of a level that contains a node; −1 if there is none.
  std::int32_t leaf_of(const double* node, int level) const { return leaf_at(lattice(node), level); }
  /// The leaf that contains lattice cell `at`, the unit cube from that position.
  std::int32_t leaf_at(const Position& at, int level) const;
  /// The leaf that contains a cell.
  std::int32_t leaf_above(std::int32_t cell, int level) const {
    while (!is_leaf(cell, level)) cell = cells_[cell].parent;
    return cell;
  }
  /// Points within this distance from a side of a cell, relative to its edge, count as on it. Otherwise
  /// rounding alone could give a vertex a tiny stiffness, whose inverse overflows floats.
  static constexpr double on_side = 1e-4;
  /// Coordinates of a point in a cell, from 0 to 1 along each axis.
  Vector3 within(const Cell& cell, const double* point) const;
  /// Edge length of a cell.
  double length(const Cell& cell) const noexcept { return unit_ * cell.size(); }
  Vector3 point(const Position& at) const;

 private:
  Position lattice(const double* node) const;
  void split(const Nodes& nodes, double ratio, const Communicator& comm);
  void find_owners(const Nodes& nodes, const Communicator& comm);

  std::vector<Cell> cells_;  ///< parents before their children
  Vector3 origin_{};
  double unit_ = 1.0;  ///< lattice spacing
};

}  // namespace kacanov
