// SPDX-License-Identifier: BSD-3-Clause
// Vertices of an octree's leaves: global numbering and hanging-node constraints.
#include "multigrid/grid_vertices.hpp"

#include <algorithm>
#include <numeric>

namespace kacanov {
namespace {

using Position = GridTree::Position;

Position corner_of(const GridTree::Cell& cell, std::size_t k) {
  Position p = cell.origin;
  for (std::size_t i = 0; i < 3; ++i)
    if ((k >> i & 1) != 0) p[i] += cell.size();
  return p;
}

bool is_corner(const GridTree::Cell& cell, const Position& at) {
  for (std::size_t i = 0; i < 3; ++i)
    if (at[i] != cell.origin[i] && at[i] != cell.origin[i] + cell.size()) return false;
  return true;
}

/// Calls visit(leaf) for the leaves that contain a position inside or on the boundary, possibly repeatedly.
template <class Visit>
void visit_round(const GridTree& tree, int level, const Position& at, const Visit& visit) {
  for (std::int32_t k = 0; k < 8; ++k)
    if (const std::int32_t leaf =
            tree.leaf_at({at[0] - (k & 1), at[1] - (k >> 1 & 1), at[2] - (k >> 2)}, level);
        leaf >= 0)
      visit(leaf);
}

}  // namespace

GridVertices::GridVertices(const GridTree& tree, int level, int ranks) : tree_(&tree), level_(level) {
  const auto cells = tree.cells();
  place_.assign(cells.size(), -1);
  std::vector<Position> at;
  std::vector<std::int32_t> owner;
  std::int32_t leaves = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!tree.is_leaf(static_cast<std::int32_t>(c), level)) continue;
    place_[c] = leaves++;
    for (std::size_t k = 0; k < 8; ++k) {
      const Position p = corner_of(cells[c], k);
      const auto [place, fresh] = vertex_.try_emplace(key(p), static_cast<std::int32_t>(at.size()));
      if (fresh) at.push_back(p), owner.push_back(cells[c].owner);
      corner_.push_back(static_cast<std::uint32_t>(place->second));
    }
  }
  row_.assign(at.size(), 0);
  starts_.assign(static_cast<std::size_t>(ranks) + 1, 0);
  for (std::size_t v = 0; v < at.size(); ++v)
    if (larger_leaf(at[v]) >= 0)
      row_[v] = -1;
    else
      ++starts_[static_cast<std::size_t>(owner[v]) + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  position_.resize(starts_.back());
  std::vector<std::int64_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t v = 0; v < at.size(); ++v)
    if (row_[v] == 0) {
      row_[v] = static_cast<std::int32_t>(next[owner[v]]++);
      position_[row_[v]] = at[v];
    }
  first_.push_back(0);
  for (const Position& p : at) {
    const std::vector<Share> shares = shares_of(p);
    shares_.insert(shares_.end(), shares.begin(), shares.end());
    first_.push_back(shares_.size());
  }
}

/// The largest leaf with a position inside, or on its boundary but not at a corner; −1 if it is a corner of
/// all leaves.
std::int32_t GridVertices::larger_leaf(const Position& at) const {
  const auto cells = tree_->cells();
  std::int32_t largest = -1;
  visit_round(*tree_, level_, at, [&](std::int32_t leaf) {
    if (!is_corner(cells[leaf], at) && (largest < 0 || cells[leaf].depth < cells[largest].depth))
      largest = leaf;
  });
  return largest;
}

std::vector<GridVertices::Share> GridVertices::shares_of(const Position& at) const {
  const auto known = vertex_.find(key(at));
  if (known != vertex_.end() && row_[known->second] >= 0) return {{row_[known->second], 1.0}};
  const std::int32_t leaf = larger_leaf(at);
  const GridTree::Cell& cell = tree_->cells()[leaf];
  Vector3 xi{};
  for (std::size_t i = 0; i < 3; ++i) xi[i] = static_cast<double>(at[i] - cell.origin[i]) / cell.size();
  const auto w = trilinear(xi);
  std::vector<Share> all;
  for (std::size_t k = 0; k < 8; ++k) {
    if (w[k] == 0.0) continue;
    for (const Share& share : shares_of(corner_of(cell, k))) {
      const auto same =
          std::find_if(all.begin(), all.end(), [&](const Share& s) { return s.row == share.row; });
      if (same == all.end())
        all.push_back({share.row, w[k] * share.weight});
      else
        same->weight += w[k] * share.weight;
    }
  }
  return all;
}

std::int32_t GridVertices::leaf_round(const Position& at) const {
  std::int32_t found = -1;
  visit_round(*tree_, level_, at, [&](std::int32_t leaf) {
    if (found < 0) found = leaf;
  });
  return found;
}

std::size_t GridVertices::bytes() const noexcept {
  return vertex_.size() * 32 + (row_.size() + place_.size() + corner_.size()) * sizeof(std::int32_t) +
         position_.size() * sizeof(Position) + first_.size() * sizeof(std::size_t) +
         shares_.size() * sizeof(Share);
}

}  // namespace kacanov
