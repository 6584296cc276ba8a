// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form on the trilinear functions of a tree.
#include "multigrid/grid_sums.hpp"

#include <algorithm>
#include <cmath>

#include <kacanov/corner_means.hpp>
#include "cells/dispatch.hpp"
#include "cells/point.hpp"

namespace kacanov {
namespace {

/// Integrals over a leaf of one weight times l₀², l₀l₁, l₁² along each axis, l₀ = 1 − ξ and l₁ = ξ: of their
/// sums all products of two trilinear functions and their derivatives consist.
struct Moments {
  std::array<double, 27> of{};

  void add(double weight, const Vector3& xi) {
    std::array<std::array<double, 3>, 3> l;
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = 1.0 - xi[k], b = xi[k];
      l[k] = {a * a, a * b, b * b};
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k) of[9 * i + 3 * j + k] += weight * l[0][i] * l[1][j] * l[2][k];
  }
};

/// Sums of moments that integrals of two trilinear functions are: along each axis the product of their
/// values, the value of one of them where the other is derived, and 1 where both are.
class Products {
 public:
  Products(const Moments& moments, double slope) : slope_(slope) {
    // Of l₀², l₀l₁, l₁²: what they stand for; l₀ = l₀² + l₀l₁, l₁ = l₀l₁ + l₁²; l₀² + 2 l₀l₁ + l₁² = 1.
    const auto spread = [](double a, double b, double c) {
      return std::array<double, 6>{a, b, c, a + b, b + c, a + 2.0 * b + c};
    };
    std::array<double, 54> last;  // 3 × 3 × 6
    for (std::size_t ij = 0; ij < 9; ++ij) {
      const double* m = &moments.of[3 * ij];
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
    for (std::size_t jk = 0; jk < 36; ++jk) {
      const auto v = spread(both[jk], both[36 + jk], both[72 + jk]);
      for (std::size_t i = 0; i < 6; ++i) of_[36 * i + jk] = v[i];
    }
  }

  /// The integral of corner functions i and j, derived along a and b (3: not at all).
  double operator()(std::size_t i, std::size_t j, std::size_t a, std::size_t b) const {
    double sign = 1.0;
    std::size_t at = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t p = i >> k & 1, q = j >> k & 1;
      if (k == a) sign *= p != 0 ? slope_ : -slope_;
      if (k == b) sign *= q != 0 ? slope_ : -slope_;
      at = 6 * at + (k == a && k == b ? 5 : k == a ? 3 + q : k == b ? 3 + p : p + q);
    }
    return sign * of_[at];
  }

 private:
  double slope_;
  std::array<double, 216> of_;
};

struct LeafMoments {
  Moments shear, bulk, volume, compliance;
};

struct LeafProducts {
  Products shear, bulk, volume, compliance;
  LeafProducts(const LeafMoments& m, double slope)
      : shear(m.shear, slope),
        bulk(m.bulk, slope),
        volume(m.volume, slope),
        compliance(m.compliance, slope) {}
};

/// 4 × 4: row i, column j.
BlockSums<4>::Block leaf_block(const LeafProducts& m, std::size_t i, std::size_t j) {
  BlockSums<4>::Block block{};
  double trace = 0.0;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t t = 0; t < 3; ++t) {
      const double rt = m.shear(i, j, r, t);  // g ∂_r φ_i ∂_t φ_j
      block[t * 4 + r] += rt;
      block[r * 4 + t] += m.bulk(i, j, r, t) - 2.0 / 3.0 * rt;
      if (r == t) trace += rt;
    }
  for (std::size_t r = 0; r < 3; ++r) {
    block[r * 4 + r] += trace;
    block[r * 4 + 3] = m.volume(i, j, r, 3);
    block[12 + r] = m.volume(i, j, 3, r);
  }
  block[15] = -m.compliance(i, j, 3, 3);
  return block;
}

/// Pressures that swing from corner to corner are seen by no trilinear displacement: beside p²/k0 they store
/// (p − p̄)²/2g, p̄ and g the leaf's means (Dohrmann and Bochev, Int. J. Numer. Meth. Fluids 46 (2004)
/// 183–201).
class Stabilisation {
 public:
  explicit Stabilisation(const LeafProducts& products) {
    double shear = 0.0;
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 8; ++j) {
        const double m = products.volume(i, j, 3, 3);
        mass_[8 * i + j] = m, share_[i] += m, volume_ += m;
        shear += products.shear(i, j, 3, 3);
      }
    softness_ = shear > 0.0 ? 0.5 * volume_ / shear : 0.0;
  }
  double operator()(std::size_t i, std::size_t j) const {
    return volume_ > 0.0 ? softness_ * (mass_[8 * i + j] - share_[i] * share_[j] / volume_) : 0.0;
  }

 private:
  std::array<double, 64> mass_{};
  std::array<double, 8> share_{};
  double volume_ = 0.0, softness_ = 0.0;
};

/// Adds w a block at (row, column) if that is the half that is kept.
void add_shares(BlockSums<4>& sums, const GridVertices::Share& row, const GridVertices::Share& column,
                const BlockSums<4>::Block& block) {
  if (row.row > column.row) return;
  auto& to = sums.at(row.row, column.row);
  const double w = row.weight * column.weight;
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += w * block[k];
}

}  // namespace

std::vector<NodeMeasure> node_measures(const Body& body, std::span<const double> g) {
  std::vector<NodeMeasure> measures(body.mesh.node_count());
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3)
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const std::int32_t* node = body.mesh.connectivity.data() + e * E::nodes;
        elements::Nodal<E> x;
        for (std::size_t a = 0; a < E::nodes; ++a)
          for (std::size_t c = 0; c < 3; ++c)
            x[a * 3 + c] = body.mesh.coordinates[static_cast<std::size_t>(node[a]) * 3 + c];
        const Law& law = body.law(e);
        const bool averages = averages_at_corners(law, body.mesh.type);
        NodeMeasure sum;
        for (std::size_t q = 0; q < E::points; ++q) {
          const double volume = elements::Point<E>(x, q).volume / E::nodes;
          sum.shear += g[e * E::points + q] * volume;
          (averages ? sum.volume : sum.bulk) += volume;
        }
        sum.bulk *= law.bulk;
        sum.compliance = sum.volume / law.bulk;
        for (std::size_t a = 0; a < E::nodes; ++a) {
          NodeMeasure& to = measures[node[a]];
          to.shear += sum.shear, to.bulk += sum.bulk;
          to.volume += sum.volume, to.compliance += sum.compliance;
        }
      }
  });
  return measures;
}

BlockSums<4> grid_sums(const GridVertices& vertices, const NodesInTree& nodes,
                       std::span<const NodeMeasure> measures, std::span<const NodeBlock> blocks) {
  const GridTree& tree = vertices.tree();
  const auto cells = tree.cells();
  std::vector<std::int32_t> place(cells.size(), -1), leaves;
  std::vector<LeafMoments> moments;
  for (std::size_t n = 0; n < measures.size(); ++n) {
    const std::int32_t leaf = tree.leaf_above(nodes.cell[n], vertices.level());
    if (place[leaf] < 0) {
      place[leaf] = static_cast<std::int32_t>(leaves.size());
      leaves.push_back(leaf);
      moments.emplace_back();
    }
    const Vector3 xi = tree.within(cells[leaf], &nodes.coordinates[3 * n]);
    LeafMoments& to = moments[place[leaf]];
    const NodeMeasure& m = measures[n];
    to.shear.add(m.shear, xi);
    if (m.bulk != 0.0) to.bulk.add(m.bulk, xi);
    to.volume.add(m.volume, xi), to.compliance.add(m.compliance, xi);
  }
  BlockSums<4> sums;
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    const double slope = 1.0 / tree.length(cells[leaves[l]]);
    const LeafProducts products(moments[l], slope);
    const Stabilisation stabilisation(products);
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 8; ++j) {
        auto block = leaf_block(products, i, j);
        block[15] -= stabilisation(i, j);
        for (const auto& row : vertices.corner(leaves[l], i))
          for (const auto& column : vertices.corner(leaves[l], j)) add_shares(sums, row, column, block);
      }
  }
  for (const NodeBlock& node : blocks) {
    const std::int32_t leaf = tree.leaf_above(nodes.cell[node.node], vertices.level());
    const auto w =
        trilinear(tree.within(cells[leaf], &nodes.coordinates[3 * static_cast<std::size_t>(node.node)]));
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 8; ++j) {
        BlockSums<4>::Block block{};
        for (std::size_t r = 0; r < 3; ++r)
          for (std::size_t t = 0; t < 3; ++t) block[r * 4 + t] = w[i] * w[j] * node.value[r * 3 + t];
        for (const auto& row : vertices.corner(leaf, i))
          for (const auto& column : vertices.corner(leaf, j)) add_shares(sums, row, column, block);
      }
  }
  return sums;
}

}  // namespace kacanov
