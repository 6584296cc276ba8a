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

/// Grids, each twice as coarse as the previous one, the last one solved directly. Data that depend only on
/// the mesh are computed once.
class GridHierarchy {
 public:
  /// `edge`: edge length of the first grid's cubes divided by the node spacing. Without `pressures` the grids
  /// have a pressure in the whole body, otherwise where these are. Collective.
  GridHierarchy(const MultigridBody& body, const PressureRows* pressures, double edge, int threads);
  /// Fit of the first grid. Collective.
  GridFit fit() const { return grid_fit(levels_.front().vertices, cell_, body_); }

  /// `g`: frozen, elements × points; `blocks`: stiffnesses of local nodes. Collective.
  void build(std::span<const double> g, std::span<const NodeBlock> blocks);
  /// Replaces only the stiffnesses. Collective.
  void change(std::span<const NodeBlock> blocks);
  /// Adds a correction for residual forces on nodes and residual volume changes at pressure rows, if there
  /// are any: `u` for the nodes that this rank owns, `p` for its rows. Collective.
  void correct(std::span<const float> force, std::span<const double> change, std::span<float> u,
               std::span<double> p);

  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const noexcept;

 private:
  struct Level {
    GridVertices vertices;
    GridLeaves leaves;
    std::optional<GridTransfer> down;  ///< to the next level; empty on the last
    std::optional<GridLevel> matrix;   ///< likewise
    std::vector<float> b, x, rest;     ///< four values per row
  };
  void cycle(std::size_t k);
  void choose_cycle();
  bool settles(std::size_t k);

  MultigridBody body_;
  VolumeOf volume_;
  int threads_;
  std::optional<GridTree> tree_;
  std::vector<std::int32_t> cell_;  ///< deepest cell of every local node
  std::deque<Level> levels_;
  std::optional<GridTransfer> nodes_, rows_;
  LevelMoments last_moments_;
  std::optional<PressureDirect> direct_;
  /// Two coarse corrections C of K per cycle: 2C − CKC, definite as long as CK < 2.
  bool twice_ = false;
};

}  // namespace kacanov
