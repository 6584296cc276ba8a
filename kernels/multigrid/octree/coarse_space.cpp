// SPDX-License-Identifier: BSD-3-Clause
// The levels of an octree below a fine level, and whether they fit the body.
#include "multigrid/octree/coarse_space.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "multigrid/cg.hpp"
#include "multigrid/cycle.hpp"
#include "multigrid/octree/octree.hpp"
#include "parallel/disjoint_sets.hpp"
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

using FragmentPair = std::array<std::int32_t, 2>;

/// Connected sets of a rank's nodes within one leaf, and the pairs of them that elements or common nodes
/// connect across leaves and ranks; gathered from all ranks, the same on each.
struct Fragments {
  std::vector<std::int32_t> leaf;
  std::vector<double> nodes;
  std::vector<FragmentPair> joined;  ///< both directions, ascending
};

Fragments fragments_of(std::span<const std::int32_t> cell, const MultigridBody& body) {
  const IndexMap& map = *body.node_map;
  const MeshView& mesh = body.body.mesh;
  const std::size_t npe = nodes_per_element(mesh.type);
  const auto node_of = [&](std::size_t e, std::size_t a) { return mesh.connectivity[e * npe + a]; };
  DisjointSets sets(cell.size());
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t a = 1; a < npe; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (cell[node_of(e, a)] == cell[node_of(e, b)]) {
          sets.join(node_of(e, a), node_of(e, b));
          break;
        }
  std::vector<std::int32_t> fragment(cell.size());
  std::vector<std::int32_t> leaf;
  std::vector<double> nodes;
  for (std::size_t n = 0; n < cell.size(); ++n) {
    const auto root = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(n)));
    if (root == n) {
      fragment[n] = static_cast<std::int32_t>(leaf.size());
      leaf.push_back(cell[n]), nodes.push_back(0.0);
    }
    fragment[n] = fragment[root];  // roots have the lowest numbers
    if (n < body.owned_nodes()) nodes[fragment[n]] += 1.0;
  }
  const auto first = static_cast<std::int32_t>(map.sum_below(static_cast<std::int64_t>(leaf.size())));
  for (std::int32_t& f : fragment) f += first;
  std::vector<FragmentPair> joined;
  std::vector<FragmentPair> lately(1024,
                                   FragmentPair{-1, -1});  // cache of recent pairs: most repeat many times
  const auto join = [&](std::int32_t f, std::int32_t g) {
    const FragmentPair pair{std::min(f, g), std::max(f, g)};
    FragmentPair& same =
        lately[(31 * static_cast<std::size_t>(pair[0]) + static_cast<std::size_t>(pair[1])) % lately.size()];
    if (f == g || same == pair) return;
    joined.push_back(pair);
    same = pair;
  };
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t a = 1; a < npe; ++a)
      for (std::size_t b = 0; b < a; ++b) join(fragment[node_of(e, a)], fragment[node_of(e, b)]);
  std::vector<std::int32_t> owners = fragment;
  map.forward(owners, 1);
  for (std::size_t n = body.owned_nodes(); n < cell.size(); ++n) join(fragment[n], owners[n]);
  std::sort(joined.begin(), joined.end());
  joined.erase(std::unique(joined.begin(), joined.end()), joined.end());

  Fragments all{gathered(leaf, map), gathered(nodes, map), gathered(joined, map)};
  const std::size_t one_way = all.joined.size();
  for (std::size_t i = 0; i < one_way; ++i) all.joined.push_back({all.joined[i][1], all.joined[i][0]});
  std::sort(all.joined.begin(), all.joined.end());
  return all;
}

/// Number of nodes of a function with these fragments, and number of those outside its largest piece.
std::array<double, 2> pieces(const Fragments& fragments, std::span<const std::int32_t> of) {
  DisjointSets sets(of.size());
  for (std::size_t i = 0; i < of.size(); ++i) {
    const auto begin =
        std::lower_bound(fragments.joined.begin(), fragments.joined.end(), FragmentPair{of[i], 0});
    for (auto at = begin; at != fragments.joined.end() && (*at)[0] == of[i]; ++at) {
      const auto other = std::lower_bound(of.begin(), of.end(), (*at)[1]);
      if (other != of.end() && *other == (*at)[1])
        sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(other - of.begin()));
    }
  }
  std::vector<double> nodes(of.size(), 0.0);
  double total = 0.0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    nodes[sets.find(static_cast<std::int32_t>(i))] += fragments.nodes[of[i]];
    total += fragments.nodes[of[i]];
  }
  return {total, total - *std::max_element(nodes.begin(), nodes.end())};
}

/// Whether a function moves nodes of both leaves.
bool share_rows(const OctreeVertices& vertices, std::int32_t a, std::int32_t b) {
  for (std::size_t i = 0; i < 8; ++i)
    for (const auto& one : vertices.corner(a, i))
      for (std::size_t j = 0; j < 8; ++j)
        for (const auto& other : vertices.corner(b, j))
          if (one.row == other.row) return true;
  return false;
}

/// A slot along a bar has 0.09 to 0.12, and 2 to 4 times the iterations of aggregates; a hook with its gap
/// has 0.013, and half the iterations.
constexpr double most_cut_off = 0.03;
/// Beyond this, elements are more than about seven times as long as wide, and cubes between their nodes are
/// empty.
constexpr double most_apart = 0.01;

}  // namespace

bool OctreeFit::pays() const noexcept { return cut_off <= most_cut_off && apart <= most_apart; }

OctreeFit octree_fit(const OctreeVertices& vertices, std::span<const std::int32_t> cell,
                     const MultigridBody& body) {
  const IndexMap& map = *body.node_map;
  const Fragments fragments = fragments_of(cell, body);
  const std::int64_t begin = vertices.starts()[map.rank], end = vertices.starts()[map.rank + 1];
  std::vector<std::vector<std::int32_t>> of_row(end - begin);
  for (std::size_t f = 0; f < fragments.leaf.size(); ++f)
    for (std::size_t k = 0; k < 8; ++k)
      for (const OctreeVertices::Share& share : vertices.corner(fragments.leaf[f], k)) {
        if (share.row < begin || share.row >= end) continue;
        auto& list = of_row[share.row - begin];
        if (list.empty() || list.back() != static_cast<std::int32_t>(f))
          list.push_back(static_cast<std::int32_t>(f));
      }
  std::array<double, 2> sums{};
  for (const auto& list : of_row) {
    if (list.empty()) continue;
    const auto row = pieces(fragments, list);
    sums[0] += row[0], sums[1] += row[1];
  }
  map.sum_all(sums);
  double apart = 0.0;
  for (const auto& [f, g] : fragments.joined)
    if (f < g && !share_rows(vertices, fragments.leaf[f], fragments.leaf[g])) apart += 2.0;
  const auto joined = static_cast<double>(fragments.joined.size());
  return {sums[0] > 0.0 ? sums[1] / sums[0] : 0.0, joined > 0.0 ? apart / joined : 0.0};
}

namespace {

/// Edge of the first grid over the node spacing; with pressures, 2.6 has 1.5 times the entries, and needs as
/// many iterations.
constexpr double first_grid = 4.0, first_pressure_grid = 3.0;
constexpr std::int64_t last_grid_rows = 300;
constexpr PressureSteps coarse_pressures{4, 8.0};

/// A vertex has three displacement components, then the pressure. A rank may have no vertices.
template <class Values>
Values pressures_of(Values values) {
  return values.empty() ? values : values.subspan(3);
}

struct WholeLeaf {
  std::int32_t cell;
  CellMoments moments;
  StiffnessMoments stiffness;
};

/// All leaves of the level, summed over all ranks.
std::vector<WholeLeaf> whole_leaves(const OctreeVertices& vertices, const OctreeLeaves& leaves,
                                    const LevelMoments& moments, const Communicator& comm) {
  std::vector<WholeLeaf> all;
  const auto mine = leaves.cell.begin();
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(vertices.tree().cells().size()); ++c) {
    if (!vertices.tree().is_leaf(c, vertices.level())) continue;
    WholeLeaf& whole = all.emplace_back(WholeLeaf{c, {}, {}});
    const auto at = std::lower_bound(mine, leaves.cell.end(), c);
    if (at == leaves.cell.end() || *at != c) continue;
    const auto leaf = static_cast<std::size_t>(at - mine);
    whole.moments = moments.leaf[leaf];
    if (moments.stiff[leaf] >= 0) whole.stiffness = moments.stiffness[moments.stiff[leaf]];
  }
  const auto each = [&](const auto& visit) {
    for (WholeLeaf& leaf : all) {
      for (Moments* m :
           {&leaf.moments.shear, &leaf.moments.bulk, &leaf.moments.volume, &leaf.moments.compliance})
        for (double& v : *m) visit(v);
      for (Moments& m : leaf.stiffness)
        for (double& v : m) visit(v);
    }
  };
  std::vector<double> sums;
  each([&](double v) { sums.push_back(v); });
  comm.sum_all(sums);
  std::size_t k = 0;
  each([&](double& v) { v = sums[k++]; });
  return all;
}

/// The whole matrix of the level of the vertices, on every rank. Collective.
LastMatrix whole_matrix(const OctreeVertices& vertices, const OctreeLeaves& leaves,
                        const LevelMoments& moments, const Communicator& comm) {
  const auto starts = vertices.starts();
  const auto row = [](std::int64_t r) { return static_cast<Eigen::Index>(grid_width) * r; };
  LastMatrix all{
      row(starts[comm.rank]), row(starts[comm.rank + 1] - starts[comm.rank]), row(starts.back()), {}, {}};
  std::vector<double> diagonal(static_cast<std::size_t>(all.total), 0.0);
  for (const WholeLeaf& leaf : whole_leaves(vertices, leaves, moments, comm)) {
    const CellStiffness form(leaf.moments, &leaf.stiffness,
                             vertices.tree().length(vertices.tree().cells()[leaf.cell]));
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 8; ++j)
        for (const auto& to : vertices.corner(leaf.cell, i))
          for (const auto& from : vertices.corner(leaf.cell, j))
            for (int k = 0; k < 16; ++k) {
              const double v = to.weight * from.weight * form.block(i, j)[static_cast<std::size_t>(k)];
              all.entries.emplace_back(4 * to.row + k / 4, 4 * from.row + k % 4, v);
              if (to.row == from.row && k % 5 == 0)
                diagonal[static_cast<std::size_t>(4 * to.row + k / 4)] += v;
            }
  }
  double stiffest = 0.0, softest = 0.0;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    double& scale = i % grid_width < 3 ? stiffest : softest;
    scale = std::max(scale, std::abs(diagonal[i]));
  }
  for (std::size_t i = 0; i < diagonal.size(); ++i)
    all.scale.push_back(i % grid_width < 3 ? stiffest : -softest);
  return all;
}

}  // namespace

OctreeSpace::OctreeSpace(const MultigridBody& body, const MultigridOptions& options,
                         const PressureRows* pressures)
    : body_(body),
      volume_(pressures != nullptr ? VolumeOf::averaging : VolumeOf::all),
      threads_(options.threads) {
  body_.like = nullptr;  // may be destroyed
  const IndexMap& map = *body.node_map;
  const std::span<const double> coordinates = body.body.mesh.coordinates;
  tree_.emplace(Octree::Nodes{coordinates, node_spacings(body.body, map), body.owned_nodes()},
                pressures != nullptr ? first_pressure_grid : first_grid, map);
  for (std::size_t n = 0; n < body.nodes(); ++n) cell_.push_back(tree_->leaf_of(&coordinates[3 * n], 0));
  const auto place = [&](std::size_t n) {
    return OctreeTransfer::Place{cell_[n], tree_->within(tree_->cells()[cell_[n]], &coordinates[3 * n])};
  };
  for (int level = 0; level <= tree_->last_level(); ++level) {
    levels_.push_back({OctreeVertices(*tree_, level, map.ranks), {}, {}, {}, {}, {}, {}});
    if (levels_.back().vertices.starts().back() <= last_grid_rows) break;
  }
  std::vector<OctreeLeaves> leaves = leaves_of_levels(*tree_, cell_, static_cast<int>(levels_.size()) - 1);
  for (std::size_t k = 0; k < levels_.size(); ++k) levels_[k].leaves = std::move(leaves[k]);
  std::vector<OctreeTransfer::Place> points;
  for (std::size_t n = 0; n < body.owned_nodes(); ++n) points.push_back(place(n));
  nodes_.emplace(levels_.front().vertices, std::move(points), map, threads_);
  if (pressures != nullptr) {
    points.clear();
    for (std::size_t r = 0; r < pressures->rows(); ++r) points.push_back(place(pressures->node(r)));
    rows_.emplace(levels_.front().vertices, std::move(points), map, threads_);
  }
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    const OctreeVertices& fine = levels_[k].vertices;
    const OctreeVertices& coarse = levels_[k + 1].vertices;
    points.clear();
    for (std::int64_t r = fine.starts()[map.rank]; r < fine.starts()[map.rank + 1]; ++r) {
      const Octree::Position& at = fine.position(static_cast<std::int32_t>(r));
      const std::int32_t leaf = coarse.leaf_round(at);
      const Octree::Cell& cell = tree_->cells()[leaf];
      Vector3 xi{};
      for (std::size_t i = 0; i < 3; ++i) xi[i] = static_cast<double>(at[i] - cell.origin[i]) / cell.size();
      points.push_back({leaf, xi});
    }
    levels_[k].down.emplace(coarse, std::move(points), map, threads_);
  }
}

void OctreeSpace::setup(std::span<const double> g, const NodeSupports&, const FineLevel& fine) {
  const std::vector<NodeBlock> blocks = grid_stiffnesses(fine, body_.owned_nodes());
  const Communicator& comm = *body_.node_map;
  LevelMoments moments = level_moments(*tree_, levels_.front().leaves, {body_.body.mesh.coordinates, cell_},
                                       node_measures(body_.body, g, volume_, threads_), blocks, threads_);
  direct_.reset();
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    Level& level = levels_[k];
    if (!level.matrix) level.matrix.emplace(level.vertices, level.leaves, comm, threads_);
    level.matrix->setup(*tree_, level.leaves, moments);
    for (auto* v : {&level.b, &level.x, &level.rest}) v->resize(grid_width * level.matrix->map().size());
    moments = raised(*tree_, level.leaves, levels_[k + 1].leaves, moments);
  }
  Level& last = levels_.back();
  direct_.emplace(whole_matrix(last.vertices, last.leaves, moments, comm), comm);
  last_moments_ = std::move(moments);
  const auto starts = last.vertices.starts();
  for (auto* v : {&last.b, &last.x})
    v->resize(grid_width * static_cast<std::size_t>(starts[comm.rank + 1] - starts[comm.rank]));
  choose_cycle();
}

void OctreeSpace::update(const NodeSupports&, const NodeSupports&, const FineLevel& fine) {
  const std::vector<NodeBlock> blocks = grid_stiffnesses(fine, body_.owned_nodes());
  LevelStiffness stiffness =
      level_stiffness(*tree_, levels_.front().leaves, {body_.body.mesh.coordinates, cell_}, blocks);
  direct_.reset();
  for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
    levels_[k].matrix->update(*tree_, levels_[k].leaves, stiffness);
    stiffness = raised(*tree_, levels_[k].leaves, levels_[k + 1].leaves, stiffness);
  }
  static_cast<LevelStiffness&>(last_moments_) = std::move(stiffness);
  const Level& last = levels_.back();
  direct_.emplace(whole_matrix(last.vertices, last.leaves, last_moments_, *body_.node_map), *body_.node_map);
  choose_cycle();
}

void OctreeSpace::restrict_forces(std::span<const float> force, std::span<const double> change) {
  Level& first = levels_.front();
  nodes_->restrict_to(force, 3, std::span(first.b), grid_width);
  if (rows_) rows_->restrict_to(change, 1, pressures_of(std::span(first.b)), grid_width);
}

void OctreeSpace::prolong(std::span<float> u, std::span<double> p) {
  const std::span<const float> x = levels_.front().x;
  std::fill(u.begin(), u.end(), 0.0F);
  nodes_->prolong(x, grid_width, 3, u);
  if (rows_) rows_->prolong(pressures_of(x), grid_width, 1, p);
}

void OctreeSpace::smooth(std::size_t k, bool before) {
  levels_[k].matrix->smooth(before, coarse_pressures, levels_[k].b, levels_[k].x);
}

void OctreeSpace::restrict_residual(std::size_t k) {
  Level& level = levels_[k];
  level.matrix->residual(level.b, level.x, level.rest);
  level.down->restrict_to(std::span<const float>(level.rest), grid_width, std::span(levels_[k + 1].b),
                          grid_width);
}

void OctreeSpace::add_correction(std::size_t k) {
  levels_[k].down->prolong(std::span<const float>(levels_[k + 1].x), grid_width, grid_width,
                           std::span(levels_[k].x));
}

void OctreeSpace::solve_last() { direct_->solve<float>(levels_.back().b, levels_.back().x); }

void OctreeSpace::choose_cycle() {
  twice_ = levels_.size() > 2;
  if (twice_ && !settles(1)) twice_ = false;
}

/// Whether repeated cycles of a level reduce an error.
bool OctreeSpace::settles(std::size_t k) {
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
    cycle(*this, k);
    for (std::size_t i = 0; i < size; ++i) error[i] += level.x[i];
  }
  return square() < before;
}

std::size_t OctreeSpace::bytes() const noexcept {
  std::size_t sum = nodes_->bytes() + (rows_ ? rows_->bytes() : 0) + cell_.size() * sizeof(std::int32_t) +
                    tree_->cells().size() * sizeof(Octree::Cell);
  for (const Level& level : levels_) {
    sum += level.vertices.bytes();
    if (level.down) sum += level.down->bytes();
    sum += (level.b.size() + level.x.size() + level.rest.size()) * sizeof(float) +
           (level.leaves.cell.size() + level.leaves.above.size()) * sizeof(std::int32_t);
    if (level.matrix) sum += level.matrix->bytes();
  }
  return sum + (direct_ ? direct_->bytes() : 0);
}

namespace {

/// Stiffness of held directions relative to that of the node: 1 takes 40 instead of 30 iterations with tet4
/// at a million unknowns.
constexpr double held_over_own = 3.0;

using Block = Eigen::Map<Eigen::Matrix3d>;

/// Projector onto the directions held at a node.
Eigen::Matrix3d projector(const HeldDirections& held) {
  Eigen::Matrix3d onto = Eigen::Matrix3d::Zero();
  for (int k = 0; k < held.count; ++k) {
    const auto& b = held.basis[static_cast<std::size_t>(k)];
    const Eigen::Vector3d direction(b[0], b[1], b[2]);
    onto += direction * direction.transpose();
  }
  return onto;
}

}  // namespace

std::vector<NodeBlock> grid_stiffnesses(const FineLevel& fine, std::size_t owned_nodes) {
  std::vector<NodeBlock> all(fine.blocks().begin(), fine.blocks().end());
  std::vector<const HeldDirections*> held_at(owned_nodes, nullptr);
  for (const HeldDirections& held : fine.space().directions)
    if (static_cast<std::size_t>(held.node) < owned_nodes && held.count > 0) held_at[held.node] = &held;
  for (NodeBlock& block : all)
    if (const HeldDirections* held = held_at[block.node]; held != nullptr) {
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - projector(*held);
      Block value(block.value.data());
      value = (across * value * across).eval();
    }
  for (std::size_t n = 0; n < owned_nodes; ++n)
    if (const HeldDirections* held = held_at[n]; held != nullptr) {
      NodeBlock& block = all.emplace_back(NodeBlock{held->node, {}});
      Block(block.value.data()) =
          held_over_own * static_cast<double>(fine.own_stiffness()[n]) * projector(*held);
    }
  const auto held = fine.held();
  for (std::size_t i = 0; i < held.size(); ++i) {
    const std::int32_t node = held[i] / 3, c = held[i] % 3;
    if (static_cast<std::size_t>(node) >= owned_nodes) break;
    NodeBlock& block = all.emplace_back(NodeBlock{node, {}});
    block.value[static_cast<std::size_t>(4 * c)] = static_cast<double>(fine.held_stiffness()[i]);
  }
  return all;
}

}  // namespace kacanov
