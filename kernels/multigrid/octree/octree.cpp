// SPDX-License-Identifier: BSD-3-Clause
// An octree around the nodes of a body, its vertices on each level, and the node spacing that decides its
// depth.
#include "multigrid/octree/octree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace kacanov {

Octree::Octree(const Nodes& nodes, double ratio, const Communicator& comm) {
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

void Octree::split(const Nodes& nodes, double ratio, const Communicator& comm) {
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

void Octree::find_owners(const Nodes& nodes, const Communicator& comm) {
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

Octree::Position Octree::lattice(const double* node) const {
  Position p{};
  for (std::size_t k = 0; k < 3; ++k) {
    // The offset puts nodes on the face between two cubes into the same one despite rounding.
    const double at = std::floor((node[k] - origin_[k]) / unit_ + 0.37);
    p[k] = static_cast<std::int32_t>(std::clamp(at, 0.0, side - 1.0));
  }
  return p;
}

std::int32_t Octree::leaf_at(const Position& at, int level) const {
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

Vector3 Octree::within(const Cell& cell, const double* point) const {
  Vector3 xi{};
  for (std::size_t k = 0; k < 3; ++k) {
    xi[k] = ((point[k] - origin_[k]) / unit_ - cell.origin[k]) / cell.size();
    if (std::abs(xi[k] - std::round(xi[k])) < on_side) xi[k] = std::round(xi[k]);
  }
  return xi;
}

Vector3 Octree::point(const Position& at) const {
  Vector3 x{};
  for (std::size_t k = 0; k < 3; ++k) x[k] = origin_[k] + unit_ * at[k];
  return x;
}

namespace {

using Position = Octree::Position;

Position corner_of(const Octree::Cell& cell, std::size_t k) {
  Position p = cell.origin;
  for (std::size_t i = 0; i < 3; ++i)
    if ((k >> i & 1) != 0) p[i] += cell.size();
  return p;
}

bool is_corner(const Octree::Cell& cell, const Position& at) {
  for (std::size_t i = 0; i < 3; ++i)
    if (at[i] != cell.origin[i] && at[i] != cell.origin[i] + cell.size()) return false;
  return true;
}

/// Calls visit(leaf) for the leaves that contain a position inside or on the boundary, possibly repeatedly.
template <class Visit>
void visit_round(const Octree& tree, int level, const Position& at, const Visit& visit) {
  for (std::int32_t k = 0; k < 8; ++k)
    if (const std::int32_t leaf =
            tree.leaf_at({at[0] - (k & 1), at[1] - (k >> 1 & 1), at[2] - (k >> 2)}, level);
        leaf >= 0)
      visit(leaf);
}

}  // namespace

OctreeVertices::OctreeVertices(const Octree& tree, int level, int ranks) : tree_(&tree), level_(level) {
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
std::int32_t OctreeVertices::larger_leaf(const Position& at) const {
  const auto cells = tree_->cells();
  std::int32_t largest = -1;
  visit_round(*tree_, level_, at, [&](std::int32_t leaf) {
    if (!is_corner(cells[leaf], at) && (largest < 0 || cells[leaf].depth < cells[largest].depth))
      largest = leaf;
  });
  return largest;
}

std::vector<OctreeVertices::Share> OctreeVertices::shares_of(const Position& at) const {
  const auto known = vertex_.find(key(at));
  if (known != vertex_.end() && row_[known->second] >= 0) return {{row_[known->second], 1.0}};
  const std::int32_t leaf = larger_leaf(at);
  const Octree::Cell& cell = tree_->cells()[leaf];
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

std::int32_t OctreeVertices::leaf_round(const Position& at) const {
  std::int32_t found = -1;
  visit_round(*tree_, level_, at, [&](std::int32_t leaf) {
    if (found < 0) found = leaf;
  });
  return found;
}

std::size_t OctreeVertices::bytes() const noexcept {
  return vertex_.size() * 32 + (row_.size() + place_.size() + corner_.size()) * sizeof(std::int32_t) +
         position_.size() * sizeof(Position) + first_.size() * sizeof(std::size_t) +
         shares_.size() * sizeof(Share);
}

namespace {

/// Ratio of nodes to elements in a body, far from its surface.
double nodes_an_element(ElementType type) {
  switch (type) {
    case ElementType::tet4: return 1.0 / 6.0;
    case ElementType::tet10: return 8.0 / 6.0;
    case ElementType::tri3: return 0.5;
    case ElementType::quad4:
    case ElementType::hex8: break;
  }
  return 1.0;
}

}  // namespace

std::vector<double> node_spacings(const Body& body, const IndexMap& nodes) {
  const std::size_t count = body.mesh.node_count(), npe = nodes_per_element(body.mesh.type);
  std::vector<double> sums(2 * count, 0.0), volume(body.mesh.element_count()), spacing(count);
  reference::volumes(body, volume);
  const double share = 1.0 / nodes_an_element(body.mesh.type), power = 1.0 / dimension(body.mesh.type);
  for (std::size_t e = 0; e < volume.size(); ++e)
    for (std::size_t a = 0; a < npe; ++a) {
      double* to = &sums[2 * static_cast<std::size_t>(body.mesh.connectivity[e * npe + a])];
      to[0] += std::pow(share * std::abs(volume[e]), power), to[1] += 1.0;
    }
  nodes.sum(sums, 2);
  for (std::size_t n = 0; n < count; ++n)
    spacing[n] = sums[2 * n + 1] > 0.0 ? sums[2 * n] / sums[2 * n + 1] : 0.0;
  return spacing;
}

}  // namespace kacanov
