// SPDX-License-Identifier: BSD-3-Clause
// A tree of cubes round the nodes of a body, whose trilinear functions are a coarse space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/communicator.hpp>
#include <kacanov/vector3.hpp>

namespace kacanov {

/// An octree, the same on every rank: cubes are halved until they are `ratio` times as large as the spacing
/// of the nodes in them; cubes without nodes are left out. A position is a point of the lattice of the
/// deepest cubes there could be (theory: background-grid).
class GridTree {
 public:
  using Position = std::array<std::int32_t, 3>;
  static constexpr int deepest = 20;
  static constexpr std::int32_t side = 1 << deepest;

  struct Cell {
    Position origin{};
    std::int32_t parent = -1, depth = 0, owner = 0;  ///< owner: the rank with most of its nodes
    std::array<std::int32_t, 8> child{-1, -1, -1, -1, -1, -1, -1, -1};
    std::int32_t height = 0;  ///< levels of cells below

    std::int32_t size() const { return side >> depth; }
  };
  /// Nodes: × 3 coordinates, and the distance between neighbours round each; the first `owned` are this
  /// rank's own.
  struct Nodes {
    std::span<const double> coordinates, spacing;
    std::size_t owned = 0;
  };

  /// Collective.
  GridTree(const Nodes& nodes, double ratio, const Communicator& comm);

  std::span<const Cell> cells() const noexcept { return cells_; }
  /// From level to level cells whose children are all leaves become leaves; on this one the root is.
  int last_level() const noexcept { return cells_.front().height; }
  bool is_leaf(std::int32_t cell, int level) const {
    const Cell& c = cells_[cell];
    return c.height <= level && (c.parent < 0 || cells_[c.parent].height > level);
  }
  /// The leaf of a level round a node; −1 where there is none.
  std::int32_t leaf_of(const double* node, int level) const { return leaf_at(lattice(node), level); }
  /// Of lattice cell `at`: the cube from there by one along each axis.
  std::int32_t leaf_at(const Position& at, int level) const;
  /// The leaf that a cell is part of.
  std::int32_t leaf_above(std::int32_t cell, int level) const {
    while (!is_leaf(cell, level)) cell = cells_[cell].parent;
    return cell;
  }
  /// Points as near as that to a side of a cell, in its lengths, are on it: a vertex that they would move
  /// with by rounding alone has a stiffness of next to nothing, and an inverse beyond floats.
  static constexpr double on_side = 1e-4;
  /// Where a point lies in a cell, 0 to 1 each way.
  Vector3 within(const Cell& cell, const double* point) const;
  /// Edge of a cell, a length.
  double length(const Cell& cell) const noexcept { return unit_ * cell.size(); }
  Vector3 point(const Position& at) const;

 private:
  Position lattice(const double* node) const;
  void split(const Nodes& nodes, double ratio, const Communicator& comm);
  void find_owners(const Nodes& nodes, const Communicator& comm);

  std::vector<Cell> cells_;  ///< parents before their children
  Vector3 origin_{};
  double unit_ = 1.0;  ///< a step of the lattice
};

}  // namespace kacanov
