// SPDX-License-Identifier: BSD-3-Clause
// The levels on background grids below a fine one.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "multigrid/corner_pressures.hpp"
#include "multigrid/grid_level.hpp"
#include "multigrid/grid_transfer.hpp"
#include "multigrid/pressure_direct.hpp"

namespace kacanov {

/// Grids from 3 times the spacing of the nodes on, each next one twice as coarse, the last one solved
/// directly. What depends on the mesh alone is made once.
class GridHierarchy {
 public:
  /// Collective.
  GridHierarchy(const MultigridBody& body, const CornerPressures& pressures, int threads);

  /// For frozen g, elements × points, and stiffnesses of local nodes. Collective.
  void build(std::span<const double> g, std::span<const NodeBlock> blocks);
  /// The same with other stiffnesses. Collective.
  void change(std::span<const NodeBlock> blocks);
  /// Adds a correction for what is left of forces on nodes and of volume changes at rows: `u` of the nodes
  /// this rank owns, `p` of its rows. Collective.
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
