// SPDX-License-Identifier: BSD-3-Clause
// The coarse spaces of rigid-body modes of aggregates, and of aggregates of these.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "multigrid/aggregation/aggregates.hpp"
#include "multigrid/aggregation/block_matrix.hpp"
#include "multigrid/cg.hpp"
#include "multigrid/cycle.hpp"
#include "multigrid/direct_solve.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid/multigrid_body.hpp"
#include "simd/motion_products.hpp"

namespace kacanov {

/// Aggregates are formed once, along strong couplings, and alone determine the sparsity pattern. Values that
/// change between setups are summed into the same blocks.
template <int M>
class AggregateMotions {
 public:
  /// `g`: elements × points, a stress. The arrays that the body points to must outlive it. Collective.
  AggregateMotions(const MultigridBody& body, std::span<const double> g, const MultigridOptions& options)
      : aggregates_(body, g, options), add_products_(simd::motion_products<M>(options.instruction_set)) {
    share_out();
  }

  std::size_t bytes() const noexcept { return aggregates_.bytes(); }
  /// Length scale of the aggregates' rotations.
  double length() const noexcept { return aggregates_.length(); }
  BlockMatrix<M> make_level() { return aggregates_.make_level(); }
  /// Sums the Galerkin matrix of B(g) + blocks on the motions into the level from make_level(); g is rounded
  /// to single precision. Collective.
  void setup(std::span<const double> g, const NodeSupports& held, BlockMatrix<M>& level) const;
  /// Changes the result of setup() with `before` to that with `after` and the same g, using the elements of
  /// nodes whose held directions differ. Collective.
  void update(std::span<const double> g, const NodeSupports& before, const NodeSupports& after,
              BlockMatrix<M>& level) const;

  /// b = the forces on the owned nodes, restricted to the motions of owned aggregates.
  void restrict_forces(std::span<const float> force, std::span<double> b) const;
  /// u = `gain` times the displacements of the owned nodes in the motions x; zero elsewhere.
  void prolong(std::span<const double> x, double gain, std::span<float> u) const;

 private:
  static constexpr std::size_t dim = Aggregates<M>::dim;
  const MultigridBody& body() const noexcept { return aggregates_.body(); }
  void share_out();

  /// A thread's aggregates in restrict_forces, and the range that contains their nodes.
  struct Share {
    std::int32_t begin = 0, end = 0;
    std::size_t first_node = 0, last_node = 0;
  };
  Aggregates<M> aggregates_;
  simd::AddMotionProducts<M> add_products_;
  std::vector<Share> shares_;
};

extern template class AggregateMotions<3>;
extern template class AggregateMotions<6>;

/// Copies the matrix of a level.
template <int M>
CoarseMatrix coarse_matrix(const BlockMatrix<M>& level, double length) {
  CoarseMatrix all{M, &level.map(), level.centres(), length, {}, {}, {}};
  level.visit_rows([&](std::int64_t row, std::int64_t column, const auto& block) {
    all.row.push_back(row);
    all.column.push_back(column);
    all.block.insert(all.block.end(), block.begin(), block.end());
  });
  return all;
}

/// Galerkin matrices over the rigid motions of aggregates (theory: aggregation, over-correction), the last
/// one factorised or handed to an external solver. Calls are collective.
template <int M>
class AggregationSpace {
 public:
  /// The arrays that the body points to must outlive it.
  AggregationSpace(const MultigridBody& body, const MultigridOptions& options);

  bool fits() const noexcept { return true; }
  /// Degree and range of the polynomial that smooths the fine level.
  int fine_degree() const noexcept { return options_.fine_degree; }
  double fine_range() const noexcept { return options_.fine_range; }

  /// `g`: elements × points. Keeps the aggregates of the first setup.
  void setup(std::span<const double> g, const NodeSupports& supports, const FineLevel& fine);
  /// Changes the supports of the last setup; `fine` has the new ones.
  void update(const NodeSupports& before, const NodeSupports& after, const FineLevel& fine);

  /// Restricts the forces on nodes, solves approximately, and sets u to the result at owned nodes.
  void restrict_forces(std::span<const float> force) { motions_->restrict_forces(force, levels_.front().b); }
  void solve() { cycle(*this); }
  void prolong(std::span<float> u) const { motions_->prolong(levels_.front().x, options_.fine_gain, u); }

  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const noexcept;

  // For cycle().
  bool is_last(std::size_t k) const noexcept { return k + 1 == levels_.size(); }
  int corrections(std::size_t k) const noexcept { return direct_ && is_last(k + 1) ? 1 : options_.cycles; }
  void smooth(std::size_t k, bool before);
  void restrict_residual(std::size_t k);
  void add_correction(std::size_t k);
  void solve_last();

 private:
  /// A level with its smoother, its vectors and the transfer to the next level.
  struct Level {
    BlockMatrix<M> matrix;
    std::vector<std::int32_t> group = {};  ///< of each owned row, in the next level; empty on the last
    std::vector<Vector3> offset = {};      ///< of each owned row, from the centre of its group
    Chebyshev smoother = {};
    Vector b, x, step, image;

    explicit Level(BlockMatrix<M> m) : matrix(std::move(m)) {
      for (auto* v : {&b, &x, &step, &image}) v->resize(matrix.size());
    }
    std::span<double> owned(Vector& v) const { return std::span(v).first(matrix.owned_size()); }
  };
  void forget_coarser();
  void set_up_coarser();

  MultigridBody body_;
  MultigridOptions options_;
  std::optional<AggregateMotions<M>> motions_;
  std::vector<Level> levels_;            ///< the first one lives as long as the aggregates
  std::optional<DefiniteSolve> direct_;  ///< of the last level, unless `coarse_` solves it
  std::unique_ptr<CoarseSolver> coarse_;
};

extern template class AggregationSpace<3>;
extern template class AggregationSpace<6>;

}  // namespace kacanov
