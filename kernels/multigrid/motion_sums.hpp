// SPDX-License-Identifier: BSD-3-Clause
// Element loop for the Galerkin matrix over rigid motions (theory: aggregation).
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <unordered_map>

#include "cells/elements.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"
#include "multigrid/aggregates.hpp"
#include "multigrid/held_space.hpp"
#include "multigrid/node_block.hpp"
#include "simd/motion_products.hpp"

namespace kacanov {

/// Sums elements and node blocks over the motions of aggregates, into a level or, without one, into separate
/// blocks.
template <int M>
class MotionSums {
  static constexpr std::size_t dim = Aggregates<M>::dim;
  using Block = typename BlockSums<M>::Block;
  using Rows = typename simd::MotionPoint<M>::Rows;

 public:
  /// `g`: elements × points, rounded to single precision; `level` may be null. The arguments must outlive it.
  MotionSums(const Aggregates<M>& aggregates, simd::AddMotionProducts<M> add_products,
             std::span<const double> g, RigidLevel<M>* level)
      : aggregates_(aggregates),
        held_(aggregates.body().held),
        add_products_(add_products),
        body_(aggregates.body().body),
        g_(g),
        level_(level) {}

  /// Restricts the sums to the rows of this share; without this call all rows are summed.
  void take_share(int share, int shares) {
    const std::int64_t rows = aggregates_.size();
    first_row_ = static_cast<std::int32_t>(rows * share / shares);
    last_row_ = static_cast<std::int32_t>(rows * (share + 1) / shares);
  }

  /// Sets the held directions and the factor of the next sums.
  void choose(const HeldSpace& space, double sign) {
    sign_ = sign;
    projector_.clear();
    bound_.assign(body_.mesh.node_count(), 0);
    for (const auto& entry : space.directions) {
      Eigen::Matrix3d p = Eigen::Matrix3d::Identity();
      for (int k = 0; k < entry.count; ++k) {
        const Eigen::Map<const Eigen::Vector3d> b(entry.basis[k].data());
        p -= b * b.transpose();
      }
      projector_.emplace(entry.node, p);
      bound_[entry.node] = 1;
    }
    for (std::size_t i = 0; i < held_.size(); ++i)
      if (held_[i] != 0) bound_[i / dim] = 1;
  }

  /// Adds the elements number(0), …, number(count − 1).
  void add_elements(std::size_t count, const auto& number) {
    elements::dispatch(body_.mesh.type, [&]<class E>(E) {
      if constexpr (static_cast<std::size_t>(E::dim) == dim) {
        for (std::size_t i = 0; i < count; ++i) add_element<E>(number(i));
      }
    });
  }

  void add_block(const NodeBlock& block) {
    const Rows z = rows(block.node);
    const std::int32_t a = aggregates_.of(block.node);
    if (!is_mine(a)) return;
    Block& sum = at(a, a);
    for (std::size_t i = 0; i < M; ++i)
      for (std::size_t j = 0; j < M; ++j) {
        double v = 0.0;
        for (std::size_t c = 0; c < dim; ++c)
          for (std::size_t d = 0; d < dim; ++d) v += z.row[c][i] * block.value[c * dim + d] * z.row[d][j];
        sum[i * M + j] += sign_ * v;
      }
  }

  /// Sums of blocks outside the level.
  BlockSums<M>& others() { return others_; }

 private:
  /// Displacement of a node for each motion of its aggregate, projected onto the space.
  Rows rows(std::int32_t node) const {
    const std::size_t n = node;
    const auto motion = RigidMotion<M>::rows(aggregates_.offset(n).data(), 1.0 / aggregates_.length());
    Rows z{};
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t m = 0; m < M; ++m) z.row[c][m] = motion[c][m];
    if (bound_[n] == 0) return z;
    for (std::size_t c = 0; c < dim; ++c)
      if (held_[n * dim + c] != 0) std::fill_n(z.row[c], M, 0.0);
    if (const auto held = projector_.find(node); held != projector_.end()) {
      const Rows free = z;
      for (std::size_t c = 0; c < dim; ++c)
        for (std::size_t m = 0; m < M; ++m) {
          z.row[c][m] = 0.0;
          for (std::size_t k = 0; k < dim; ++k)
            z.row[c][m] +=
                held->second(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) * free.row[k][m];
        }
    }
    return z;
  }

  bool is_mine(std::int32_t row) const { return row >= first_row_ && row < last_row_; }
  bool is_in_level(std::int32_t a, std::int32_t b) const {
    return level_ != nullptr && (aggregates_.is_owned(a) || aggregates_.is_owned(b));
  }
  /// Whether block (a, b) is stored, not (b, a).
  bool in_order(std::int32_t a, std::int32_t b) const {
    return is_in_level(a, b) ? a <= b : aggregates_.number(a) <= aggregates_.number(b);
  }
  Block& at(std::int32_t a, std::int32_t b) {
    return is_in_level(a, b) ? level_->block(a, b) : others_.at(aggregates_.number(a), aggregates_.number(b));
  }

  /// A rigid motion does not strain an element within a single aggregate, unless a node is bound or the body
  /// is axisymmetric. (Deriving the diagonal blocks from the others, because a global motion strains nothing,
  /// would save half of the products but loses too many digits on stretched meshes.)
  template <class E>
  void add_element(std::size_t e) {
    constexpr std::size_t npe = E::nodes;
    const std::int32_t* node = body_.mesh.connectivity.data() + e * npe;
    std::array<std::int32_t, npe> which{};  // the aggregates of its nodes
    std::array<std::size_t, npe> local{};   // index of each node's aggregate in `which`
    std::size_t count = 0;
    bool rigid = body_.mesh.plane != PlaneState::axisymmetric;
    for (std::size_t a = 0; a < npe; ++a) {
      rigid = rigid && bound_[node[a]] == 0;
      const std::int32_t group = aggregates_.of(node[a]);
      std::size_t k = 0;
      while (k < count && which[k] != group) ++k;
      if (k == count) which[count++] = group;
      local[a] = k;
    }
    if (rigid && count == 1) return;

    std::array<simd::MotionPair, npe*(npe + 1) / 2> pairs;
    std::size_t pair_count = 0;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a; b < count; ++b) {
        const bool ordered = in_order(which[a], which[b]);
        const std::size_t row = ordered ? a : b, column = ordered ? b : a;
        if (!is_mine(which[row])) continue;
        pairs[pair_count++] = {row, column, at(which[row], which[column]).data()};
      }
    if (pair_count == 0) return;

    elements::Nodal<E> x;
    std::array<Rows, npe> z;
    for (std::size_t a = 0; a < npe; ++a) {
      z[a] = rows(node[a]);
      for (std::size_t c = 0; c < dim; ++c)
        x[a * dim + c] = body_.mesh.coordinates[static_cast<std::size_t>(node[a]) * dim + c];
    }
    const Law& law = body_.law(e);
    const auto points = elements::points_of<E>(x, law.mean_dilatation, body_.mesh.plane);
    for (std::size_t q = 0; q < E::points; ++q) {
      const auto& point = points[q];
      const auto g = static_cast<double>(static_cast<float>(g_[e * static_cast<std::size_t>(E::points) + q]));
      const double volume = sign_ * point.volume, shear = 2.0 * g * volume,
                   modulus =
                       body_.mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g) : law.bulk,
                   bulk = modulus * volume;
      add_products_({npe, count, point.gradient[0], point.dilatation[0],
                     body_.mesh.plane == PlaneState::axisymmetric ? point.hoop : nullptr, z.data(),
                     local.data(), shear, bulk},
                    pairs.data(), pair_count);
    }
  }

  const Aggregates<M>& aggregates_;
  std::span<const std::uint8_t> held_;
  simd::AddMotionProducts<M> add_products_;
  Body body_;
  std::span<const double> g_;
  RigidLevel<M>* level_;
  BlockSums<M> others_;
  double sign_ = 1.0;
  std::int32_t first_row_ = 0, last_row_ = std::numeric_limits<std::int32_t>::max();
  std::vector<std::uint8_t> bound_;
  std::unordered_map<std::int32_t, Eigen::Matrix3d> projector_;
};

}  // namespace kacanov
