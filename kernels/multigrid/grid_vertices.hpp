// SPDX-License-Identifier: BSD-3-Clause
// Vertices of an octree's leaves: global numbering and hanging-node constraints.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "multigrid/grid_tree.hpp"

namespace kacanov {

/// The trilinear functions on the leaves of one level of a tree: one per row, numbered rank by rank. A corner
/// in the middle of a larger leaf's face or edge is a hanging node: its value is that of the larger leaf
/// there. The same on every rank.
class GridVertices {
 public:
  struct Share {
    std::int32_t row;
    double weight;
  };

  /// The tree must outlive it.
  GridVertices(const GridTree& tree, int level, int ranks);

  const GridTree& tree() const noexcept { return *tree_; }
  int level() const noexcept { return level_; }

  /// ranks + 1 entries: the first row of each rank, and the total.
  std::span<const std::int64_t> starts() const noexcept { return starts_; }
  /// Position of a row's vertex.
  const GridTree::Position& position(std::int32_t row) const { return position_[row]; }
  /// Rows and weights of corner k (bit i: upper along axis i) of a leaf.
  std::span<const Share> corner(std::int32_t leaf, std::size_t k) const {
    const std::size_t v = corner_[static_cast<std::size_t>(place_[leaf]) * 8 + k];
    return std::span(shares_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  /// A leaf with a position inside or on its boundary; −1 if there is none.
  std::int32_t leaf_round(const GridTree::Position& at) const;

  std::size_t bytes() const noexcept;

 private:
  static std::uint64_t key(const GridTree::Position& at) {
    return static_cast<std::uint64_t>(at[0]) << 42 | static_cast<std::uint64_t>(at[1]) << 21 |
           static_cast<std::uint64_t>(at[2]);
  }
  std::vector<Share> shares_of(const GridTree::Position& at) const;
  std::int32_t larger_leaf(const GridTree::Position& at) const;

  const GridTree* tree_;
  int level_;
  std::unordered_map<std::uint64_t, std::int32_t> vertex_;  ///< index by position
  std::vector<std::int32_t> row_;                           ///< per vertex, −1 for a hanging one
  std::vector<GridTree::Position> position_;                ///< per row
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

}  // namespace kacanov
