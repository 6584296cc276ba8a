// SPDX-License-Identifier: BSD-3-Clause
// The levels on background grids below a fine one.
#include "multigrid/grid_hierarchy.hpp"

#include <utility>

#include "multigrid/largest_eigenvalue.hpp"
#include "multigrid/node_spacing.hpp"
#include "multigrid/sums.hpp"

namespace kacanov {
namespace {

constexpr std::int64_t last_grid_rows = 300;
constexpr PressureSteps coarse_pressures{4, 8.0};

}  // namespace

GridHierarchy::GridHierarchy(const MultigridBody& body, const PressureRows* pressures, double edge,
                             int threads)
    : body_(body), volume_(pressures != nullptr ? VolumeOf::averaging : VolumeOf::all), threads_(threads) {
  body_.like = nullptr;  // may be destroyed
  const IndexMap& map = *body.node_map;
  const std::span<const double> coordinates = body.body.mesh.coordinates;
  tree_.emplace(GridTree::Nodes{coordinates, node_spacings(body.body, map), body.owned_nodes()}, edge, map);
  for (std::size_t n = 0; n < body.nodes(); ++n) cell_.push_back(tree_->leaf_of(&coordinates[3 * n], 0));
  const auto place = [&](std::size_t n) {
    return GridTransfer::Place{cell_[n], tree_->within(tree_->cells()[cell_[n]], &coordinates[3 * n])};
  };
  for (int level = 0; level <= tree_->last_level(); ++level) {
    levels_.push_back({GridVertices(*tree_, level, map.ranks), {}, {}, {}, {}, {}, {}});
    if (levels_.back().vertices.starts().back() <= last_grid_rows) break;
  }
  std::vector<GridLeaves> leaves = leaves_of_levels(*tree_, cell_, static_cast<int>(levels_.size()) - 1);
  for (std::size_t k = 0; k < levels_.size(); ++k) levels_[k].leaves = std::move(leaves[k]);
  std::vector<GridTransfer::Place> points;
  for (std::size_t n = 0; n < body.owned_nodes(); ++n) points.push_back(place(n));
  nodes_.emplace(levels_.front().vertices, std::move(points), map, threads);
  if (pressures != nullptr) {
    points.clear();
    for (std::size_t r = 0; r < pressures->rows(); ++r) points.push_back(place(pressures->node(r)));
    rows_.emplace(levels_.front().vertices, std::move(points), map, threads);
  }
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    const GridVertices& fine = levels_[k].vertices;
    const GridVertices& coarse = levels_[k + 1].vertices;
    points.clear();
    for (std::int64_t r = fine.starts()[map.rank]; r < fine.starts()[map.rank + 1]; ++r) {
      const GridTree::Position& at = fine.position(static_cast<std::int32_t>(r));
      const std::int32_t leaf = coarse.leaf_round(at);
      const GridTree::Cell& cell = tree_->cells()[leaf];
      Vector3 xi{};
      for (std::size_t i = 0; i < 3; ++i) xi[i] = static_cast<double>(at[i] - cell.origin[i]) / cell.size();
      points.push_back({leaf, xi});
    }
    levels_[k].down.emplace(coarse, std::move(points), map, threads);
  }
}

void GridHierarchy::build(std::span<const double> g, std::span<const NodeBlock> blocks) {
  const Communicator& comm = *body_.node_map;
  LevelMoments moments = level_moments(*tree_, levels_.front().leaves, {body_.body.mesh.coordinates, cell_},
                                       node_measures(body_.body, g, volume_, threads_), blocks, threads_);
  direct_.reset();
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    Level& level = levels_[k];
    if (!level.matrix) level.matrix.emplace(level.vertices, level.leaves, comm, threads_);
    level.matrix->build(*tree_, level.leaves, moments);
    for (auto* v : {&level.b, &level.x, &level.rest}) v->resize(grid_width * level.matrix->map().size());
    moments = raised(*tree_, level.leaves, levels_[k + 1].leaves, moments);
  }
  Level& last = levels_.back();
  direct_.emplace(last.vertices, last.leaves, moments, comm);
  last_moments_ = std::move(moments);
  const auto starts = last.vertices.starts();
  for (auto* v : {&last.b, &last.x})
    v->resize(grid_width * static_cast<std::size_t>(starts[comm.rank + 1] - starts[comm.rank]));
  choose_cycle();
}

void GridHierarchy::change(std::span<const NodeBlock> blocks) {
  LevelStiffness stiffness =
      level_stiffness(*tree_, levels_.front().leaves, {body_.body.mesh.coordinates, cell_}, blocks);
  direct_.reset();
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    levels_[k].matrix->change(*tree_, levels_[k].leaves, stiffness);
    stiffness = raised(*tree_, levels_[k].leaves, levels_[k + 1].leaves, stiffness);
  }
  static_cast<LevelStiffness&>(last_moments_) = std::move(stiffness);
  const Level& last = levels_.back();
  direct_.emplace(last.vertices, last.leaves, last_moments_, *body_.node_map);
  choose_cycle();
}

void GridHierarchy::correct(std::span<const float> force, std::span<const double> change, std::span<float> u,
                            std::span<double> p) {
  Level& first = levels_.front();
  // A vertex has three displacement components, then the pressure. A rank may have no vertices.
  const auto from_pressure = [](auto values) { return values.empty() ? values : values.subspan(3); };
  nodes_->restrict_to(force, 3, std::span(first.b), grid_width);
  if (rows_) rows_->restrict_to(change, 1, from_pressure(std::span(first.b)), grid_width);
  cycle(0);
  nodes_->prolong(std::span<const float>(first.x), grid_width, 3, u);
  if (rows_) rows_->prolong(from_pressure(std::span<const float>(first.x)), grid_width, 1, p);
}

/// x of a level from its b, starting from zero.
void GridHierarchy::cycle(std::size_t k) {
  Level& level = levels_[k];
  if (k + 1 == levels_.size()) return direct_->solve(level.b, level.x);
  level.matrix->smooth(true, coarse_pressures, level.b, level.x);
  Level& next = levels_[k + 1];
  const int corrections = twice_ && k + 2 < levels_.size() ? 2 : 1;
  for (int turn = 0; turn < corrections; ++turn) {
    level.matrix->residual(level.b, level.x, level.rest);
    level.down->restrict_to(std::span<const float>(level.rest), grid_width, std::span(next.b), grid_width);
    cycle(k + 1);
    level.down->prolong(std::span<const float>(next.x), grid_width, grid_width, std::span(level.x));
  }
  level.matrix->smooth(false, coarse_pressures, level.b, level.x);
}

void GridHierarchy::choose_cycle() {
  twice_ = levels_.size() > 2;
  if (twice_ && !settles(1)) twice_ = false;
}

/// Whether repeated cycles of a level reduce an error.
bool GridHierarchy::settles(std::size_t k) {
  constexpr int steps = 8, last = 3;
  Level& level = levels_[k];
  const std::size_t size = grid_width * level.matrix->rows();
  std::vector<float> error = scattered<float>(level.matrix->map(), grid_width);
  const std::vector<float> nothing(level.b.size(), 0.0F);
  const auto square = [&] {
    const auto term = [&](std::size_t i) {  // only of displacements
      return i % grid_width < 3 ? static_cast<double>(error[i]) * static_cast<double>(error[i]) : 0.0;
    };
    return body_.node_map->sum_all(eight_sums(size, term));
  };
  double before = 0.0;
  for (int s = 0; s < steps; ++s) {
    if (s == steps - last) before = square();
    level.matrix->residual(nothing, error, level.b);
    cycle(k);
    for (std::size_t i = 0; i < size; ++i) error[i] += level.x[i];
  }
  return square() < before;
}

std::size_t GridHierarchy::bytes() const noexcept {
  std::size_t sum = nodes_->bytes() + (rows_ ? rows_->bytes() : 0) + cell_.size() * sizeof(std::int32_t) +
                    tree_->cells().size() * sizeof(GridTree::Cell);
  for (const Level& level : levels_) {
    sum += level.vertices.bytes();
    if (level.down) sum += level.down->bytes();
    sum += (level.b.size() + level.x.size() + level.rest.size()) * sizeof(float) +
           (level.leaves.cell.size() + level.leaves.above.size()) * sizeof(std::int32_t);
    if (level.matrix) sum += level.matrix->bytes();
  }
  return sum + (direct_ ? direct_->bytes() : 0);
}

}  // namespace kacanov
