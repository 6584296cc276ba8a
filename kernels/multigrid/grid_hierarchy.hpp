// SPDX-License-Identifier: BSD-3-Clause
// The levels on background grids below a fine one.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "multigrid/grid_fit.hpp"
#include "multigrid/grid_level.hpp"
#include "multigrid/grid_transfer.hpp"
#include "multigrid/pressure_direct.hpp"
#include "multigrid/pressure_rows.hpp"

namespace kacanov {

/// Grids, each twice as coarse as the one before, the last one solved directly. What depends on the mesh
/// alone is made once.
class GridHierarchy {
 public:
  /// `edge` of the first one over the spacing of the nodes. Without `pressures` grids have one of
  /// their own all over the body, with them one where these are. Collective.
  GridHierarchy(const MultigridBody& body, const PressureRows* pressures, double edge, int threads);
  /// Of the first grid. Collective.
  GridFit fit() const { return grid_fit(levels_.front().vertices, cell_, body_); }

  /// For frozen g, elements × points, and stiffnesses of local nodes. Collective.
  void build(std::span<const double> g, std::span<const NodeBlock> blocks);
  /// The same with other stiffnesses. Collective.
  void change(std::span<const NodeBlock> blocks);
  /// Adds a correction for what is left of forces on nodes and of volume changes at rows of the pressures, if
  /// there are any: `u` of the nodes this rank owns, `p` of its rows. Collective.
  void correct(std::span<const float> force, std::span<const double> change, std::span<float> u,
               std::span<double> p);

  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const noexcept;

 private:
  struct Level {
    GridVertices vertices;
    GridLeaves leaves;
    std::optional<GridTransfer> down;  ///< to the next; none on the last
    std::optional<GridLevel> matrix;   ///< likewise
    std::vector<float> b, x, rest;     ///< four values a row
  };
  void cycle(std::size_t k);
  void choose_cycle();
  bool settles(std::size_t k);

  MultigridBody body_;
  VolumeOf volume_;
  int threads_;
  std::optional<GridTree> tree_;
  std::vector<std::int32_t> cell_;  ///< the deepest, of every local node
  std::deque<Level> levels_;
  std::optional<GridTransfer> nodes_, rows_;
  LevelMoments last_moments_;
  std::optional<PressureDirect> direct_;
  /// Two corrections of a level by the next one, C of K: 2C − CKC, definite as long as CK < 2.
  bool twice_ = false;
};

}  // namespace kacanov
