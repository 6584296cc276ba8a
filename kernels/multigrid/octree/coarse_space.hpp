// SPDX-License-Identifier: BSD-3-Clause
// The levels of an octree below a fine level, and whether they fit the body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "multigrid/cycle.hpp"
#include "multigrid/direct_solve.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/octree/level.hpp"
#include "multigrid/octree/octree.hpp"
#include "multigrid/pressure_rows.hpp"

namespace kacanov {

struct OctreeFit {
  /// Share of nodes that are not in the largest connected piece of their function's nodes, over all
  /// functions. Where elements do not connect these nodes, the function moves pieces together that can move
  /// apart. 0 for solid bodies, up to a half for two pieces.
  double cut_off = 0.0;
  /// Share of the pairs of cubes, among those that elements join, in which no function connects the two
  /// sides: cubes smaller than elements leave empty cubes between the nodes.
  double apart = 0.0;
  /// Whether cycles on the grid are better than those on aggregates.
  bool pays() const noexcept;
};

/// For the grid of `vertices`; `cell`: leaf of every local node. Collective.
OctreeFit octree_fit(const OctreeVertices& vertices, std::span<const std::int32_t> cell,
                     const MultigridBody& body);

/// Stiffnesses of the nodes that this rank owns: the fine level's blocks; at held components its diagonal; in
/// held directions a few times the stiffness of their node's elements, instead of the stiff blocks that fix
/// them (theory: background-grid). For bodies in 3D.
std::vector<NodeBlock> grid_stiffnesses(const FineLevel& fine, std::size_t owned_nodes);

/// Displacements and pressures on grids, each twice as coarse as the previous one, the last one solved
/// directly. Data that depend only on the mesh are computed once. Calls are collective.
class OctreeSpace {
 public:
  /// Without `pressures` the grids have a pressure in the whole body, otherwise where these are.
  OctreeSpace(const MultigridBody& body, const MultigridOptions& options,
              const PressureRows* pressures = nullptr);

  /// Whether the first grid fits the body.
  bool fits() const { return octree_fit(levels_.front().vertices, cell_, body_).pays(); }
  /// Degree and range of the polynomial that smooths the fine level without pressures: 3, 4 and 15 or 5, 6
  /// and 30 take the same time within 5 % (docs/experiments.md#background-cycle).
  static constexpr int fine_degree() noexcept { return 5; }
  static constexpr double fine_range() noexcept { return 20.0; }

  /// `g`: frozen, elements × points.
  void setup(std::span<const double> g, const NodeSupports& supports, const FineLevel& fine);
  /// Replaces only the stiffnesses of nodes.
  void update(const NodeSupports& before, const NodeSupports& after, const FineLevel& fine);

  /// Restricts residual forces on nodes and residual volume changes at pressure rows, if there are any.
  void restrict_forces(std::span<const float> force, std::span<const double> change = {});
  void solve() { cycle(*this); }
  /// Sets u to the result at the nodes that this rank owns, zero elsewhere; adds it to p.
  void prolong(std::span<float> u, std::span<double> p = {});

  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const noexcept;

  // For cycle().
  bool is_last(std::size_t k) const noexcept { return k + 1 == levels_.size(); }
  int corrections(std::size_t k) const noexcept { return twice_ && !is_last(k + 1) ? 2 : 1; }
  void smooth(std::size_t k, bool before);
  void restrict_residual(std::size_t k);
  void add_correction(std::size_t k);
  void solve_last();

 private:
  struct Level {
    OctreeVertices vertices;
    OctreeLeaves leaves;
    std::optional<OctreeTransfer> down;  ///< to the next level; empty on the last
    std::optional<OctreeLevel> matrix;   ///< likewise
    std::vector<float> b, x, rest;       ///< four values per row
  };
  void choose_cycle();
  bool settles(std::size_t k);

  MultigridBody body_;
  VolumeOf volume_;
  int threads_;
  std::optional<Octree> tree_;
  std::vector<std::int32_t> cell_;  ///< deepest cell of every local node
  std::deque<Level> levels_;
  std::optional<OctreeTransfer> nodes_, rows_;
  LevelMoments last_moments_;
  std::optional<SaddlePointSolve> direct_;
  /// Two coarse corrections C of K per cycle: 2C − CKC, definite as long as CK < 2.
  bool twice_ = false;
};

}  // namespace kacanov
