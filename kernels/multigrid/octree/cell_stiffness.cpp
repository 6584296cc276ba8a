// SPDX-License-Identifier: BSD-3-Clause
// Moments of an octree's leaves, and the displacement–pressure form computed from them.
#include "multigrid/octree/cell_stiffness.hpp"

#include <algorithm>

#include <kacanov/corner_means.hpp>
#include "cells/elements.hpp"
#include "cells/point.hpp"
#include "cells/straight.hpp"
#include "operator/threads.hpp"

namespace kacanov {
namespace {

/// Moments of a unit weight at a point of the leaf.
Moments moments_at(const Vector3& xi) {
  std::array<std::array<double, 3>, 3> l;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = 1.0 - xi[k], b = xi[k];
    l[k] = {a * a, a * b, b * b};
  }
  Moments m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) m[9 * i + 3 * j + k] = l[0][i] * l[1][j] * l[2][k];
  return m;
}

void add_scaled(Moments& to, double weight, const Moments& m) {
  for (std::size_t k = 0; k < m.size(); ++k) to[k] += weight * m[k];
}

/// Converts moments to those of the cube twice as large in which the leaf is this octant (bit i: the upper
/// half along axis i). In the lower half, L₀ = l₀ + l₁/2 and L₁ = l₁/2; in the upper half the other way
/// around.
Moments in_larger(Moments m, std::size_t octant) {
  for (std::size_t axis = 0, stride = 9; axis < 3; ++axis, stride /= 3)
    for (std::size_t k = 0; k < 9; ++k) {
      double* at = &m[axis == 0 ? k : axis == 1 ? 9 * (k / 3) + k % 3 : 3 * k];
      const bool upper = (octant >> axis & 1) != 0;
      double &near = at[upper ? 2 * stride : 0], &cross = at[stride], &far = at[upper ? 0 : 2 * stride];
      near += cross + 0.25 * far, cross = 0.5 * cross + 0.25 * far, far *= 0.25;
    }
  return m;
}

void add_raised(Moments& to, const Moments& m, int octant) {
  add_scaled(to, 1.0, octant < 0 ? m : in_larger(m, static_cast<std::size_t>(octant)));
}

/// Octant of `child` in its parent `cell`, −1 if it is the cell itself.
int octant_of(const Octree::Cell& cell, std::int32_t child) {
  const auto at = std::find(cell.child.begin(), cell.child.end(), child);
  return at == cell.child.end() ? -1 : static_cast<int>(at - cell.child.begin());
}

/// Index of each cell among the leaves.
std::vector<std::int32_t> places_of(const Octree& tree, const OctreeLeaves& leaves) {
  std::vector<std::int32_t> place(tree.cells().size(), -1);
  for (std::size_t l = 0; l < leaves.cell.size(); ++l) place[leaves.cell[l]] = static_cast<std::int32_t>(l);
  return place;
}

Moments moments_of_node(const Octree& tree, const NodesInTree& nodes, std::size_t n) {
  return moments_at(tree.within(tree.cells()[nodes.cell[n]], &nodes.coordinates[3 * n]));
}

template <class E>
bool straight_sides(const elements::Nodal<E>& x) {
  if constexpr (E::simplex) return elements::has_straight_sides(x);
  return false;
}

/// Integrals over an element, divided by its number of nodes.
template <class E>
NodeMeasure element_measure(const Body& body, std::span<const double> g, VolumeOf volume, std::size_t e) {
  const elements::Nodal<E> x = elements::coordinates_of<E>(body.mesh, e);
  const Law& law = body.law(e);
  NodeMeasure sum;
  double all = 0.0;
  std::array<double, E::points> volumes;
  if (straight_sides<E>(x))
    volumes.fill(elements::StraightSides(x.data()).volume / E::points);
  else
    for (std::size_t q = 0; q < E::points; ++q) volumes[q] = elements::Point<E>(x, q).volume;
  for (std::size_t q = 0; q < E::points; ++q) {
    const double share = volumes[q] / E::nodes;
    sum.shear += g[e * E::points + q] * share;
    all += share;
  }
  if (volume == VolumeOf::all || law.mean_dilatation)
    sum.volume = all, sum.compliance = all / law.bulk;
  else
    sum.bulk = law.bulk * all;
  return sum;
}

}  // namespace

std::vector<NodeMeasure> node_measures(const Body& body, std::span<const double> g, VolumeOf volume,
                                       int threads) {
  std::vector<NodeMeasure> measures(body.mesh.node_count());
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3) {
      constexpr std::size_t piece = 8192;
      std::vector<NodeMeasure> of_element(piece);
      for (std::size_t first = 0; first < body.mesh.element_count(); first += piece) {
        const std::size_t count = std::min(piece, body.mesh.element_count() - first);
        each_in_shares(threads, count, [&](std::size_t e) {
          of_element[e] = element_measure<E>(body, g, volume, first + e);
        });
        for (std::size_t e = 0; e < count; ++e)
          for (std::size_t a = 0; a < E::nodes; ++a) {
            NodeMeasure& to = measures[body.mesh.connectivity[(first + e) * E::nodes + a]];
            to.shear += of_element[e].shear, to.bulk += of_element[e].bulk;
            to.volume += of_element[e].volume, to.compliance += of_element[e].compliance;
          }
      }
    }
  });
  return measures;
}

std::vector<OctreeLeaves> leaves_of_levels(const Octree& tree, std::span<const std::int32_t> cell, int last) {
  std::vector<OctreeLeaves> levels(1);
  std::vector<std::int32_t> place(tree.cells().size());
  const auto take = [&](OctreeLeaves& to, std::span<const std::int32_t> from, int level,
                        std::vector<std::int32_t>* which) {
    std::fill(place.begin(), place.end(), -1);
    for (const std::int32_t c : from) place[tree.leaf_above(c, level)] = 0;
    for (std::size_t c = 0; c < place.size(); ++c)
      if (place[c] == 0) {
        place[c] = static_cast<std::int32_t>(to.cell.size());
        to.cell.push_back(static_cast<std::int32_t>(c));
      }
    for (std::size_t i = 0; which != nullptr && i < from.size(); ++i)
      which->push_back(place[tree.leaf_above(from[i], level)]);
  };
  take(levels.front(), cell, 0, nullptr);
  for (int level = 1; level <= last; ++level) {
    OctreeLeaves next;
    take(next, levels.back().cell, level, &levels.back().above);
    levels.push_back(std::move(next));
  }
  return levels;
}

LevelMoments level_moments(const Octree& tree, const OctreeLeaves& leaves, const NodesInTree& nodes,
                           std::span<const NodeMeasure> measures, std::span<const NodeBlock> blocks,
                           int threads) {
  const std::vector<std::int32_t> place = places_of(tree, leaves);
  LevelMoments sums;
  sums.leaf.resize(leaves.cell.size());
  const auto team = static_cast<std::size_t>(threads);
  in_team(threads, [&](int t) {
    const std::size_t share = t, count = leaves.cell.size();
    const std::size_t begin = count * share / team, end = count * (share + 1) / team;
    for (std::size_t n = 0; n < measures.size(); ++n) {
      const std::size_t l = place[nodes.cell[n]];
      if (l < begin || l >= end) continue;
      const Moments m = moments_of_node(tree, nodes, n);
      CellMoments& to = sums.leaf[l];
      const NodeMeasure& of = measures[n];
      add_scaled(to.shear, of.shear, m);
      if (of.bulk != 0.0) add_scaled(to.bulk, of.bulk, m);
      if (of.volume == 0.0) continue;
      add_scaled(to.volume, of.volume, m), add_scaled(to.compliance, of.compliance, m);
    }
  });
  static_cast<LevelStiffness&>(sums) = level_stiffness(tree, leaves, nodes, blocks);
  return sums;
}

LevelStiffness level_stiffness(const Octree& tree, const OctreeLeaves& leaves, const NodesInTree& nodes,
                               std::span<const NodeBlock> blocks) {
  const std::vector<std::int32_t> place = places_of(tree, leaves);
  LevelStiffness sums;
  sums.stiff.assign(leaves.cell.size(), -1);
  for (const NodeBlock& block : blocks) {
    std::int32_t& which = sums.stiff[place[nodes.cell[block.node]]];
    if (which < 0) {
      which = static_cast<std::int32_t>(sums.stiffness.size());
      sums.stiffness.emplace_back();
    }
    const Moments m = moments_of_node(tree, nodes, static_cast<std::size_t>(block.node));
    for (std::size_t r = 0, k = 0; r < 3; ++r)
      for (std::size_t t = r; t < 3; ++t) add_scaled(sums.stiffness[which][k++], block.value[r * 3 + t], m);
  }
  return sums;
}

LevelMoments raised(const Octree& tree, const OctreeLeaves& fine, const OctreeLeaves& coarse,
                    const LevelMoments& moments) {
  LevelMoments sums;
  sums.leaf.resize(coarse.cell.size());
  for (std::size_t l = 0; l < fine.cell.size(); ++l) {
    const std::size_t above = fine.above[l];
    const int octant = octant_of(tree.cells()[coarse.cell[above]], fine.cell[l]);
    const CellMoments& from = moments.leaf[l];
    CellMoments& to = sums.leaf[above];
    add_raised(to.shear, from.shear, octant), add_raised(to.bulk, from.bulk, octant);
    add_raised(to.volume, from.volume, octant), add_raised(to.compliance, from.compliance, octant);
  }
  static_cast<LevelStiffness&>(sums) =
      raised(tree, fine, coarse, static_cast<const LevelStiffness&>(moments));
  return sums;
}

LevelStiffness raised(const Octree& tree, const OctreeLeaves& fine, const OctreeLeaves& coarse,
                      const LevelStiffness& moments) {
  LevelStiffness sums;
  sums.stiff.assign(coarse.cell.size(), -1);
  for (std::size_t l = 0; l < fine.cell.size(); ++l) {
    if (moments.stiff[l] < 0) continue;
    const std::size_t above = fine.above[l];
    const int octant = octant_of(tree.cells()[coarse.cell[above]], fine.cell[l]);
    if (sums.stiff[above] < 0) {
      sums.stiff[above] = static_cast<std::int32_t>(sums.stiffness.size());
      sums.stiffness.emplace_back();
    }
    for (std::size_t k = 0; k < 6; ++k)
      add_raised(sums.stiffness[sums.stiff[above]][k], moments.stiffness[moments.stiff[l]][k], octant);
  }
  return sums;
}

namespace {

/// Sums of moments that are integrals of two trilinear functions: along each axis the product of their values
/// (l₀², l₀l₁, l₁²), the value of one where the other is differentiated (l₀, l₁), and 1 where both are.
using Products = std::array<double, 216>;

Products products_of(const Moments& moments) {
  // From l₀², l₀l₁, l₁²: l₀ = l₀² + l₀l₁, l₁ = l₀l₁ + l₁²; l₀² + 2 l₀l₁ + l₁² = 1.
  const auto spread = [](double a, double b, double c) {
    return std::array<double, 6>{a, b, c, a + b, b + c, a + 2.0 * b + c};
  };
  std::array<double, 54> last;  // 3 × 3 × 6
  for (std::size_t ij = 0; ij < 9; ++ij) {
    const double* m = &moments[3 * ij];
    const auto v = spread(m[0], m[1], m[2]);
    for (std::size_t k = 0; k < 6; ++k) last[6 * ij + k] = v[k];
  }
  std::array<double, 108> both;  // 3 × 6 × 6
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 6; ++k) {
      const double* m = &last[18 * i + k];
      const auto v = spread(m[0], m[6], m[12]);
      for (std::size_t j = 0; j < 6; ++j) both[36 * i + 6 * j + k] = v[j];
    }
  Products of;
  for (std::size_t jk = 0; jk < 36; ++jk) {
    const auto v = spread(both[jk], both[36 + jk], both[72 + jk]);
    for (std::size_t i = 0; i < 6; ++i) of[36 * i + jk] = v[i];
  }
  return of;
}

/// Index in Products of the integral of corner functions i and j, differentiated along a and b (3: not), and
/// its sign, for derivatives with respect to ξ.
struct Term {
  std::uint8_t at = 0;
  std::int8_t sign = 1;
};

constexpr Term term_of(std::size_t i, std::size_t j, std::size_t a, std::size_t b) {
  std::size_t at = 0;
  int sign = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = i >> k & 1, q = j >> k & 1;
    if (k == a && p == 0) sign = -sign;
    if (k == b && q == 0) sign = -sign;
    at = 6 * at + (k == a && k == b ? 5 : k == a ? 3 + q : k == b ? 3 + p : p + q);
  }
  return {static_cast<std::uint8_t>(at), static_cast<std::int8_t>(sign)};
}

constexpr auto leaf_terms = [] {
  std::array<Term, 1024> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = term_of(k >> 7, k >> 4 & 7, k >> 2 & 3, k & 3);
  return all;
}();

/// The terms of corners i and j.
struct Pair {
  const Term* terms;  ///< 4 × 4: differentiated along a, b
  Pair(std::size_t i, std::size_t j) : terms(&leaf_terms[(8 * i + j) << 4]) {}
  double operator()(const Products& of, std::size_t a, std::size_t b) const {
    const Term& term = terms[4 * a + b];
    return term.sign * of[term.at];
  }
};

}  // namespace

CellStiffness::CellStiffness(const CellMoments& moments, const StiffnessMoments* stiffness, double length) {
  const double slope = 1.0 / length;
  const Products shear = products_of(moments.shear), bulk = products_of(moments.bulk),
                 volume = products_of(moments.volume), compliance = products_of(moments.compliance);
  const double total_shear = shear[215], total_volume = volume[215];
  std::array<double, 64> mass{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j) {
      const Pair pair(i, j);
      Block& block = block_[8 * i + j];
      block.fill(0.0);
      double trace = 0.0;
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t t = 0; t < 3; ++t) {
          const double rt = slope * slope * pair(shear, r, t);  // g ∂_r φ_i ∂_t φ_j
          block[t * 4 + r] += rt;
          block[r * 4 + t] += slope * slope * pair(bulk, r, t) - 2.0 / 3.0 * rt;
          if (r == t) trace += rt;
        }
      for (std::size_t r = 0; r < 3; ++r) {
        block[r * 4 + r] += trace;
        block[r * 4 + 3] = slope * pair(volume, r, 3);
        block[12 + r] = slope * pair(volume, 3, r);
      }
      block[15] = -pair(compliance, 3, 3);
      mass[8 * i + j] = mass[8 * j + i] = pair(volume, 3, 3);
    }
  if (total_volume > 0.0 && total_shear > 0.0) add_stabilisation(mass, 0.5 * total_volume / total_shear);
  if (stiffness != nullptr) add_stiffness(*stiffness);
  mirror();
}

void CellStiffness::add_stabilisation(const std::array<double, 64>& mass, double softness) {
  std::array<double, 8> share{};
  double volume = 0.0;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) share[i] += mass[8 * i + j];
    volume += share[i];
  }
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j)
      block_[8 * i + j][15] -= softness * (mass[8 * i + j] - share[i] * share[j] / volume);
}

void CellStiffness::add_stiffness(const StiffnessMoments& stiffness) {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j) {
      std::size_t at = 0;
      for (std::size_t k = 0; k < 3; ++k) at = 3 * at + (i >> k & 1) + (j >> k & 1);
      Block& block = block_[8 * i + j];
      for (std::size_t r = 0, k = 0; r < 3; ++r)
        for (std::size_t t = r; t < 3; ++t, ++k) {
          block[4 * r + t] += stiffness[k][at];
          if (t != r) block[4 * t + r] += stiffness[k][at];
        }
    }
}

void CellStiffness::mirror() {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t t = 0; t < 4; ++t) block_[8 * i + j][4 * r + t] = block_[8 * j + i][4 * t + r];
}

}  // namespace kacanov
