// SPDX-License-Identifier: BSD-3-Clause
// Octree around the nodes of a body, whose trilinear functions form a coarse space.
#include "multigrid/grid_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kacanov {

GridTree::GridTree(const Nodes& nodes, double ratio, const Communicator& comm) {
  std::array<double, 6> reach;  // −lower, upper
  reach.fill(-std::numeric_limits<double>::max());
  std::array<double, 2> sums{};
  for (std::size_t n = 0; n < nodes.owned; ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = nodes.coordinates[3 * n + k];
      reach[k] = std::max(reach[k], -x), reach[3 + k] = std::max(reach[3 + k], x);
    }
    sums[0] += nodes.spacing[n], sums[1] += 1.0;
  }
  comm.max_all(reach);
  comm.sum_all(sums);
  double extent = 0.0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, reach[k] + reach[3 + k]);
  // Chosen so that the cubes of a uniform mesh end with exactly the requested size.
  double length = ratio * (sums[1] > 0.0 ? sums[0] / sums[1] : 1.0);
  while (length < 1.001 * extent) length *= 2.0;
  unit_ = length / side;
  for (std::size_t k = 0; k < 3; ++k) origin_[k] = 0.5 * (reach[3 + k] - reach[k] - length);
  cells_.emplace_back();
  split(nodes, ratio, comm);
  find_owners(nodes, comm);
}

void GridTree::split(const Nodes& nodes, double ratio, const Communicator& comm) {
  std::vector<std::int32_t> at(nodes.owned, 0);  // cell of every node
  std::vector<std::int32_t> active{0};
  for (int depth = 0; depth < deepest && !active.empty(); ++depth) {
    // Number of nodes, and the sum of their spacings, in the children of every active cell.
    std::vector<std::int32_t> place(cells_.size(), -1);
    for (std::size_t i = 0; i < active.size(); ++i) place[active[i]] = static_cast<std::int32_t>(i);
    std::vector<double> sums(16 * active.size(), 0.0);
    const auto child_of = [&](std::size_t n) {
      const Position p = lattice(&nodes.coordinates[3 * n]);
      std::size_t child = 0;
      for (std::size_t k = 0; k < 3; ++k)
        child |= static_cast<std::size_t>(p[k] >> (deepest - 1 - depth) & 1) << k;
      return child;
    };
    for (std::size_t n = 0; n < nodes.owned; ++n)
      if (const std::int32_t i = place[at[n]]; i >= 0) {
        double* sum = &sums[16 * static_cast<std::size_t>(i) + 2 * child_of(n)];
        sum[0] += 1.0, sum[1] += nodes.spacing[n];
      }
    comm.sum_all(sums);
    std::vector<std::int32_t> next;
    for (std::size_t i = 0; i < active.size(); ++i) {
      const std::int32_t parent = active[i];
      double count = 0.0, spacing = 0.0;
      for (std::size_t c = 0; c < 8; ++c) count += sums[16 * i + 2 * c], spacing += sums[16 * i + 2 * c + 1];
      // Threshold between two sizes: √2 times the requested one.
      if (count < 2.0 || length(cells_[parent]) * count < 1.42 * ratio * spacing) continue;
      for (std::size_t c = 0; c < 8; ++c) {
        if (sums[16 * i + 2 * c] == 0.0) continue;
        Cell child;
        child.parent = parent;
        child.depth = depth + 1;
        child.origin = cells_[parent].origin;
        for (std::size_t k = 0; k < 3; ++k)
          if ((c >> k & 1) != 0) child.origin[k] += child.size();
        cells_[parent].child[c] = static_cast<std::int32_t>(cells_.size());
        next.push_back(static_cast<std::int32_t>(cells_.size()));
        cells_.push_back(child);
      }
    }
    for (std::size_t n = 0; n < nodes.owned; ++n)
      if (place[at[n]] >= 0)
        if (const std::int32_t child = cells_[at[n]].child[child_of(n)]; child >= 0) at[n] = child;
    active.swap(next);
  }
  for (std::size_t c = cells_.size(); c-- > 1;) {
    Cell& parent = cells_[cells_[c].parent];
    parent.height = std::max(parent.height, cells_[c].height + 1);
  }
}

void GridTree::find_owners(const Nodes& nodes, const Communicator& comm) {
  if (comm.ranks == 1) return;
  const std::size_t ranks = comm.ranks, mine = comm.rank;
  std::vector<double> count(cells_.size() * ranks, 0.0);
  for (std::size_t n = 0; n < nodes.owned; ++n)
    count[static_cast<std::size_t>(leaf_of(&nodes.coordinates[3 * n], 0)) * ranks + mine] += 1.0;
  comm.sum_all(count);
  for (std::size_t c = cells_.size(); c-- > 0;) {
    const double* of = &count[c * ranks];
    cells_[c].owner = static_cast<std::int32_t>(std::max_element(of, of + ranks) - of);
    if (cells_[c].parent >= 0)
      for (std::size_t r = 0; r < ranks; ++r)
        count[static_cast<std::size_t>(cells_[c].parent) * ranks + r] += of[r];
  }
}

GridTree::Position GridTree::lattice(const double* node) const {
  Position p{};
  for (std::size_t k = 0; k < 3; ++k) {
    // The offset puts nodes on the face between two cubes into the same one despite rounding.
    const double at = std::floor((node[k] - origin_[k]) / unit_ + 0.37);
    p[k] = static_cast<std::int32_t>(std::clamp(at, 0.0, side - 1.0));
  }
  return p;
}

std::int32_t GridTree::leaf_at(const Position& at, int level) const {
  for (const std::int32_t p : at)
    if (p < 0 || p >= side) return -1;
  std::int32_t c = 0;
  while (c >= 0 && cells_[c].height > level) {
    const int shift = deepest - 1 - cells_[c].depth;
    std::size_t child = 0;
    for (std::size_t k = 0; k < 3; ++k) child |= static_cast<std::size_t>(at[k] >> shift & 1) << k;
    c = cells_[c].child[child];
  }
  return c;
}

Vector3 GridTree::within(const Cell& cell, const double* point) const {
  Vector3 xi{};
  for (std::size_t k = 0; k < 3; ++k) {
    xi[k] = ((point[k] - origin_[k]) / unit_ - cell.origin[k]) / cell.size();
    if (std::abs(xi[k] - std::round(xi[k])) < on_side) xi[k] = std::round(xi[k]);
  }
  return xi;
}

Vector3 GridTree::point(const Position& at) const {
  Vector3 x{};
  for (std::size_t k = 0; k < 3; ++k) x[k] = origin_[k] + unit_ * at[k];
  return x;
}

}  // namespace kacanov
