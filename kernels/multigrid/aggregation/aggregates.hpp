// SPDX-License-Identifier: BSD-3-Clause
// Aggregates of nodes: pairwise matching along strong couplings, and the centres of the results.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>
#include "multigrid/aggregation/block_matrix.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// A symmetric graph in compressed row storage, without its diagonal; it stores both directions of an edge.
struct WeightedGraph {
  std::vector<std::int64_t> start;   ///< size rows + 1
  std::vector<std::int32_t> column;  ///< one entry per edge of a row
  std::vector<float> weight;         ///< likewise; positive, larger for stronger edges

  std::int32_t rows() const noexcept { return static_cast<std::int32_t>(start.size()) - 1; }
};

/// Returns the group of each row (theory: aggregation). Joins rows, then pairs, then groups of four ... along
/// their heaviest edges until groups have `size` ≥ 1 rows on average, not counting rows without neighbours,
/// or nothing can be joined. Groups are numbered from 0 in the order of their first rows. Not collective:
/// only rows of this rank.
std::vector<std::int32_t> aggregate(WeightedGraph graph, double size);

/// Options for grouping the first `nodes` nodes of a body (those that a rank owns) by their couplings; `g`:
/// elements × points, a stress.
struct NodeAggregation {
  double size = 48.0;
  /// Number of consecutive nodes grouped at a time: a graph of all nodes would be the largest array of a run.
  std::int32_t section = 1 << 15;
  int threads = 1;  ///< affects only the time
};
std::vector<std::int32_t> aggregate_nodes(const Body& body, std::span<const double> g, std::int32_t nodes,
                                          const NodeAggregation& options);

/// Node aggregates, formed once: those of a rank follow strong couplings of its owned nodes. M: number of
/// rigid-body modes, 3 in 2D and 6 in 3D.
template <int M>
class Aggregates {
 public:
  static constexpr std::size_t dim = RigidMotion<M>::dim;

  /// `g`: elements × points, a stress. The arrays that the body points to must outlive it. Collective.
  Aggregates(const MultigridBody& body, std::span<const double> g, const MultigridOptions& options);

  /// Creates the level of the aggregates, with zero blocks for all couplings through elements; afterwards
  /// ghosts have an aggregate too. Call it once. Collective.
  BlockMatrix<M> make_level();

  const MultigridBody& body() const noexcept { return body_; }
  int threads() const noexcept { return threads_; }
  /// Length that makes rotations comparable to translations: root mean square distance of nodes from the
  /// centre of their aggregate.
  double length() const noexcept { return length_; }
  /// Aggregate of a local node: owned ones first, then those of other ranks in the order of the level, then
  /// the rest.
  std::int32_t of(std::size_t node) const noexcept { return group_[node]; }
  /// Number of owned and other aggregates.
  std::int64_t size() const noexcept { return static_cast<std::int64_t>(centre_.size()); }
  bool is_owned(std::int32_t aggregate) const noexcept { return aggregate < owned_; }
  /// Global number.
  std::int64_t number(std::int32_t aggregate) const noexcept {
    return is_owned(aggregate) ? first_ + aggregate : number_[aggregate - owned_];
  }
  std::size_t bytes() const noexcept {
    return group_.size() * sizeof(std::int32_t) + centre_.size() * sizeof(Vector3) +
           number_.size() * sizeof(std::int64_t);
  }
  /// Vector from the centre of its aggregate to a local node.
  Vector3 offset(std::size_t node) const noexcept {
    const Vector3& centre = centre_[group_[node]];
    Vector3 d{};
    for (std::size_t c = 0; c < dim; ++c) d[c] = body_.body.mesh.coordinates[node * dim + c] - centre[c];
    return d;
  }

 private:
  MultigridBody body_;
  int threads_;
  std::vector<std::int32_t> group_;   ///< per node; at first only of the owned ones
  std::vector<Vector3> centre_;       ///< per aggregate
  std::vector<std::int64_t> number_;  ///< of the aggregates that are not owned
  std::int32_t owned_ = 0;
  std::int64_t first_ = 0;  ///< global number of the first owned one
  double length_ = 1.0;
};

extern template class Aggregates<3>;
extern template class Aggregates<6>;

}  // namespace kacanov
