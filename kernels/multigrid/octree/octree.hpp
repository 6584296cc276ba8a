// SPDX-License-Identifier: BSD-3-Clause
// An octree around the nodes of a body, its vertices on each level, and the node spacing that decides its
// depth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <kacanov/communicator.hpp>
#include <kacanov/index_map.hpp>
#include <kacanov/reference.hpp>
#include <kacanov/vector3.hpp>

namespace kacanov {

/// An octree, the same on every rank: cubes are split until their edge is `ratio` times the node spacing in
/// them; cubes without nodes are omitted. A position is a point of the lattice of the deepest possible cubes
/// (theory: background-grid).
class Octree {
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
  Octree(const Nodes& nodes, double ratio, const Communicator& comm);

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

/// The trilinear functions on the leaves of one level of a tree: one per row, numbered rank by rank. A corner
/// in the middle of a larger leaf's face or edge is a hanging node: its value is that of the larger leaf
/// there. The same on every rank.
class OctreeVertices {
 public:
  struct Share {
    std::int32_t row;
    double weight;
  };

  /// The tree must outlive it.
  OctreeVertices(const Octree& tree, int level, int ranks);

  const Octree& tree() const noexcept { return *tree_; }
  int level() const noexcept { return level_; }

  /// ranks + 1 entries: the first row of each rank, and the total.
  std::span<const std::int64_t> starts() const noexcept { return starts_; }
  /// Position of a row's vertex.
  const Octree::Position& position(std::int32_t row) const { return position_[row]; }
  /// Rows and weights of corner k (bit i: upper along axis i) of a leaf.
  std::span<const Share> corner(std::int32_t leaf, std::size_t k) const {
    const std::size_t v = corner_[static_cast<std::size_t>(place_[leaf]) * 8 + k];
    return std::span(shares_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  /// A leaf with a position inside or on its boundary; −1 if there is none.
  std::int32_t leaf_round(const Octree::Position& at) const;

  std::size_t bytes() const noexcept;

 private:
  static std::uint64_t key(const Octree::Position& at) {
    return static_cast<std::uint64_t>(at[0]) << 42 | static_cast<std::uint64_t>(at[1]) << 21 |
           static_cast<std::uint64_t>(at[2]);
  }
  std::vector<Share> shares_of(const Octree::Position& at) const;
  std::int32_t larger_leaf(const Octree::Position& at) const;

  const Octree* tree_;
  int level_;
  std::unordered_map<std::uint64_t, std::int32_t> vertex_;  ///< index by position
  std::vector<std::int32_t> row_;                           ///< per vertex, −1 for a hanging one
  std::vector<Octree::Position> position_;                  ///< per row
  std::vector<std::int64_t> starts_;
  std::vector<std::int32_t> place_;    ///< index of a cell among the leaves
  std::vector<std::uint32_t> corner_;  ///< leaves × 8: vertices
  std::vector<std::size_t> first_;     ///< size vertices + 1, index into shares_
  std::vector<Share> shares_;
};

/// Values at a point of the trilinear functions of a cell's corners.
template <class Real>
std::array<Real, 8> trilinear(const std::array<Real, 3>& xi) {
  std::array<Real, 8> w{};
  for (std::size_t k = 0; k < 8; ++k)
    w[k] = ((k & 1) != 0 ? xi[0] : Real(1) - xi[0]) * ((k & 2) != 0 ? xi[1] : Real(1) - xi[1]) *
           ((k & 4) != 0 ? xi[2] : Real(1) - xi[2]);
  return w;
}

/// Distance between neighbours around every local node, in the unit of the coordinates, from the volumes of
/// its elements and the number of nodes per element inside a body. `nodes`: index map of the nodes.
/// Collective.
std::vector<double> node_spacings(const Body& body, const IndexMap& nodes);

}  // namespace kacanov
