// SPDX-License-Identifier: BSD-3-Clause
// Background octree grids and the multigrid cycle on displacements and pressures: iterations independent of
// k0/g.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../sanitized.hpp"
#include "amg/make_preconditioner.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid/octree/coarse_space.hpp"
#include "multigrid/octree/level.hpp"
#include "multigrid/octree/octree.hpp"
#include "pressure_bodies.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

struct Grids {
  Vector spacing;
  Octree tree;
  explicit Grids(const Part& part)
      : spacing(node_spacings(part.body(), part.node_map)), tree(nodes(part), 2.6, part.node_map) {}
  Octree::Nodes nodes(const Part& part) const {
    return {part.body().mesh.coordinates, spacing, static_cast<std::size_t>(part.owned_nodes())};
  }
  std::vector<OctreeTransfer::Place> places(const Part& part) const {
    std::vector<OctreeTransfer::Place> all;
    for (std::size_t n = 0; n < static_cast<std::size_t>(part.owned_nodes()); ++n) {
      const double* x = &part.body().mesh.coordinates[3 * n];
      const std::int32_t leaf = tree.leaf_of(x, 0);
      all.push_back({leaf, tree.within(tree.cells()[leaf], x)});
    }
    return all;
  }
};

/// Returns 1 + x − 2y + 3z.
double linear(const Vector3& x) { return 1.0 + x[0] - 2.0 * x[1] + 3.0 * x[2]; }

double sum_all(double v) {
  MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return v;
}

}  // namespace

TEST_CASE("trees have cells as large as the spacing of nodes asks for, round every node") {
  for (const bool graded : {false, true}) {
    const Part part = bar(4, graded);
    const Grids grids(part);
    int smallest = 0, largest = Octree::deepest;
    for (std::size_t n = 0; n < part.nodes(); ++n) {
      const std::int32_t leaf = grids.tree.leaf_of(&part.body().mesh.coordinates[3 * n], 0);
      REQUIRE(leaf >= 0);
      smallest = std::max(smallest, grids.tree.cells()[leaf].depth);
      largest = std::min(largest, grids.tree.cells()[leaf].depth);
      CHECK(grids.tree.length(grids.tree.cells()[leaf]) < 4.0 * 2.6 * grids.spacing[n]);
    }
    CHECK(sum_all(smallest > largest ? 1.0 : 0.0) > (graded ? 0.5 : -0.5));
    if (!graded) CHECK(smallest == largest);
    CHECK(grids.tree.leaf_at({-1, 0, 0}, 0) == -1);
  }
}

TEST_CASE("points next to a side of a cell but for rounding are on it") {
  const Part part = bar(3, true);
  const Grids grids(part);
  for (const Octree::Cell& cell : grids.tree.cells()) {
    const Vector3 corner = grids.tree.point(cell.origin);
    const double length = grids.tree.length(cell);
    const Vector3 beside{corner[0] + 1e-9 * length, corner[1] - 1e-9 * length, corner[2] + 0.25 * length};
    const Vector3 xi = grids.tree.within(cell, beside.data());
    CHECK(xi[0] == 0.0);
    CHECK(xi[1] == 0.0);
    CHECK(xi[2] == doctest::Approx(0.25));
  }
}

TEST_CASE("trilinear functions are linear ones' exactly, next to larger cells and on every level") {
  for (const bool graded : {false, true}) {
    CAPTURE(graded);
    const Part part = bar(4, graded);
    const Grids grids(part);
    const int rank = part.node_map.rank;
    for (int level = 0; level <= grids.tree.last_level(); ++level) {
      const OctreeVertices vertices(grids.tree, level, part.node_map.ranks);
      auto places = grids.places(part);
      for (std::size_t n = 0; n < places.size(); ++n) {
        const double* x = &part.body().mesh.coordinates[3 * n];
        places[n].leaf = grids.tree.leaf_of(x, level);
        places[n].within = grids.tree.within(grids.tree.cells()[places[n].leaf], x);
      }
      OctreeTransfer transfer(vertices, places, part.node_map, 1);
      std::vector<float> rows;
      for (std::int64_t r = vertices.starts()[rank]; r < vertices.starts()[rank + 1]; ++r)
        rows.push_back(
            static_cast<float>(linear(grids.tree.point(vertices.position(static_cast<std::int32_t>(r))))));
      Vector at(places.size(), 0.0);
      transfer.prolong(std::span<const float>(rows), 1, 1, std::span(at));
      for (std::size_t n = 0; n < at.size(); ++n) {
        const double* x = &part.body().mesh.coordinates[3 * n];
        CHECK(at[n] == doctest::Approx(linear({x[0], x[1], x[2]})).epsilon(1e-5));
      }
      // Restriction is the transpose of prolongation.
      Vector force(at.size());
      std::vector<float> down(rows.size());
      for (std::size_t n = 0; n < force.size(); ++n) force[n] = std::sin(static_cast<double>(n) + rank);
      transfer.restrict_to(std::span<const double>(force), 1, std::span(down), 1);
      const double up = std::inner_product(at.begin(), at.end(), force.begin(), 0.0);
      const double work = std::inner_product(rows.begin(), rows.end(), down.begin(), 0.0);
      CHECK(sum_all(up) == doctest::Approx(sum_all(work)).epsilon(1e-5));
    }
  }
}

TEST_CASE("grids' matrices are blind to rigid motions, have uniform strain's energy, C's mass, and springs") {
  const Part part = bar(3, true);
  const Body body = part.body();
  const Grids grids(part);
  std::vector<std::int32_t> cells;
  for (std::size_t n = 0; n < part.nodes(); ++n)
    cells.push_back(grids.tree.leaf_of(&body.mesh.coordinates[3 * n], 0));
  const int last = grids.tree.last_level();
  const auto leaves = leaves_of_levels(grids.tree, cells, last);
  const Vector g(body.secant_count(), 0.5);
  const NodesInTree nodes{body.mesh.coordinates, cells};
  // Springs of 2 along the first axis and 3 along the second, coupled.
  std::vector<NodeBlock> springs;
  for (std::int32_t n = 0; n < part.owned_nodes(); n += 7)
    springs.push_back({n, {2.0, 1.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 0.0}});
  std::vector<NodeBlock> others;
  for (std::int32_t n = 0; n < part.owned_nodes(); n += 5)
    others.push_back({n, {4e3, 0.0, 0.0, 0.0, 5e3, 0.0, 0.0, 0.0, 6e3}});
  const double spring_count = sum_all(static_cast<double>(springs.size()));
  for (const int threads : {1, 2})
    for (const bool changed : {false, true})
      for (const bool held : {false, true}) {
        // With `changed`, the level is built with other springs, which are then replaced.
        const auto of = held ? std::span<const NodeBlock>(springs) : std::span<const NodeBlock>();
        LevelMoments moments =
            level_moments(grids.tree, leaves[0], nodes, node_measures(body, g, VolumeOf::averaging, threads),
                          changed ? std::span<const NodeBlock>(others) : of, threads);
        LevelStiffness stiffness = level_stiffness(grids.tree, leaves[0], nodes, of);
        for (int k = 0; k <= last; ++k) {
          CAPTURE(threads);
          CAPTURE(held);
          CAPTURE(k);
          const OctreeVertices vertices(grids.tree, k, part.node_map.ranks);
          if (k > 0) {
            moments = raised(grids.tree, leaves[k - 1], leaves[k], moments);
            stiffness = raised(grids.tree, leaves[k - 1], leaves[k], stiffness);
          }
          OctreeLevel level(vertices, leaves[k], part.node_map, threads);
          level.setup(grids.tree, leaves[k], moments);
          if (changed) level.update(grids.tree, leaves[k], stiffness);
          const auto residual = [&](const auto& displacement, double pressure) {
            std::vector<float> b(grid_width * level.map().size(), 0.0F), x = b, r = b;
            for (std::size_t i = 0; i < level.rows(); ++i) {
              const auto row = static_cast<std::int32_t>(level.map().first() + static_cast<std::int64_t>(i));
              const Vector3 u = displacement(grids.tree.point(vertices.position(row)));
              for (std::size_t c = 0; c < 3; ++c) x[grid_width * i + c] = static_cast<float>(u[c]);
              x[grid_width * i + 3] = static_cast<float>(pressure);
            }
            level.residual(b, x, r);
            double energy = 0.0, change = 0.0, largest = 0.0;
            for (std::size_t i = 0; i < level.rows(); ++i) {
              for (std::size_t c = 0; c < 3; ++c) {
                const auto force = static_cast<double>(r[grid_width * i + c]);
                energy -= static_cast<double>(x[grid_width * i + c]) * force;
                largest = std::max(largest, std::abs(force));
              }
              change += static_cast<double>(r[grid_width * i + 3]);
            }
            return std::array<double, 3>{sum_all(energy), sum_all(change), largest};
          };
          const auto moved = residual([](const Vector3&) { return Vector3{1.0, 1.0, 1.0}; }, 0.0);
          CHECK(std::abs(moved[0] - (held ? 7.0 * spring_count : 0.0)) < 1e-5 * (1.0 + spring_count));
          if (held) continue;
          const auto still = residual(
              [](const Vector3& x) {
                return Vector3{1.0 - x[1], x[0] - x[2], x[1] + 2.0};
              },
              0.0);
          CHECK(still[2] < 4e-6);
          CHECK(std::abs(still[1]) < 4e-6);
          // ε_xx = 1 over the volume 2: 2g dev ε:dev ε = 2/3, and tr ε = 1.
          const auto stretched = residual([](const Vector3& x) { return Vector3{x[0], 0.0, 0.0}; }, 0.0);
          CHECK(stretched[0] == doctest::Approx(2.0 * 2.0 / 3.0).epsilon(1e-5));
          CHECK(stretched[1] == doctest::Approx(-2.0).epsilon(1e-5));
          const auto pressed = residual([](const Vector3&) { return Vector3{}; }, 1.0);
          CHECK(pressed[1] == doctest::Approx(2.0 / body.law(0).bulk).epsilon(1e-5));
        }
      }
}

TEST_CASE(
    "grids have directions that are held as stiff as their node is thrice, and the rest of its blocks") {
  const Part part = bar(2, false);
  FineLevel fine(multigrid_body(part), {}, FinePart::deviator);
  const Vector3 held{0.6, 0.0, 0.8}, along{0.8, 0.0, -0.6};
  ConstrainedSpace space;
  std::vector<NodeBlock> blocks;
  for (std::int32_t n = 0; n < part.owned_nodes(); ++n) {
    if (part.held[3 * static_cast<std::size_t>(n)] != 0) continue;
    HeldDirections& directions = space.directions.emplace_back(HeldDirections{n, 1, {}});
    directions.basis[0] = held;
    NodeBlock& block = blocks.emplace_back(NodeBlock{n, {}});
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        block.value[3 * r + c] = 1e4 * held[r] * held[c] + 7.0 * along[r] * along[c] + (r == c ? 2.0 : 0.0);
  }
  fine.setup(bent(part, 10.0), {blocks, space});
  std::vector<std::array<double, 9>> sum(part.nodes());
  for (const NodeBlock& block : grid_stiffnesses(fine, part.owned_nodes()))
    for (std::size_t k = 0; k < 9; ++k) sum[block.node][k] += block.value[k];
  const auto energy = [](const std::array<double, 9>& block, const Vector3& a, const Vector3& b) {
    double e = 0.0;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) e += a[r] * block[3 * r + c] * b[c];
    return e;
  };
  for (const HeldDirections& at : space.directions) {
    const double own = static_cast<double>(fine.own_stiffness()[at.node]);
    CHECK(own > 0.0);
    CHECK(energy(sum[at.node], held, held) == doctest::Approx(3.0 * own));
    CHECK(energy(sum[at.node], along, along) == doctest::Approx(9.0));
    CHECK(std::abs(energy(sum[at.node], held, along)) < 1e-9);
  }
  for (const std::int32_t i : fine.held())
    if (i / 3 < part.owned_nodes()) CHECK(sum[i / 3][static_cast<std::size_t>(4 * (i % 3))] > 0.0);
}

TEST_CASE(
    "grids fit solid bodies; a slot cuts functions, long elements leave cubes between their nodes empty") {
  enum class Kind { solid, slot, stretched };
  for (const Kind kind : {Kind::solid, Kind::slot, Kind::stretched}) {
    CAPTURE(static_cast<int>(kind));
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    Model model = elastic_model();
    model.boundary.push_back(moved(named("left"), 3));
    Problem problem;
    if (rank == 0) {
      Mesh mesh = make_box({{2, 1, 1}, {16, 8, 8}, ElementType::hex8});
      // For x > 0.5 the elements above the middle get their own nodes there, which makes a slot.
      std::vector<std::int32_t> twin(mesh.node_count(), -1);
      const std::size_t nodes = mesh.node_count();
      for (std::size_t n = 0; kind == Kind::slot && n < nodes; ++n) {
        const Vector3 x{mesh.coordinates[3 * n], mesh.coordinates[3 * n + 1], mesh.coordinates[3 * n + 2]};
        if (x[0] < 0.51 || std::abs(x[2] - 0.5) > 1e-6) continue;
        twin[n] = static_cast<std::int32_t>(mesh.coordinates.size() / 3);
        mesh.coordinates.insert(mesh.coordinates.end(), x.begin(), x.end());
      }
      for (std::size_t e = 0; e < mesh.element_count(); ++e) {
        double middle = 0.0;
        for (std::size_t a = 0; a < 8; ++a)
          middle += mesh.coordinates[3 * static_cast<std::size_t>(mesh.elements[8 * e + a]) + 2] / 8.0;
        for (std::size_t a = 0; middle > 0.5 && a < 8; ++a) {
          std::int32_t& node = mesh.elements[8 * e + a];
          if (twin[node] >= 0) node = twin[node];
        }
      }
      for (std::size_t i = 0; kind == Kind::stretched && i < mesh.coordinates.size(); i += 3)
        mesh.coordinates[i] *= 16.0;
      problem = build_problem(mesh, model);
    }
    const Part part = distribute(rank == 0 ? &problem : nullptr, MPI_COMM_WORLD);
    const Vector spacing = node_spacings(part.body(), part.node_map);
    const Octree tree({part.body().mesh.coordinates, spacing, static_cast<std::size_t>(part.owned_nodes())},
                      3.0, part.node_map);
    std::vector<std::int32_t> cell;
    for (std::size_t n = 0; n < part.nodes(); ++n)
      cell.push_back(tree.leaf_of(&part.body().mesh.coordinates[3 * n], 0));
    const OctreeFit fit =
        octree_fit(OctreeVertices(tree, 0, part.node_map.ranks), cell, multigrid_body(part));
    CHECK((fit.cut_off > 0.03) == (kind == Kind::slot));
    CHECK((fit.apart > 0.01) == (kind == Kind::stretched));
    if (kind == Kind::solid) CHECK(fit.cut_off == 0.0);
    if (kind == Kind::solid) CHECK(fit.apart == 0.0);
  }
}

TEST_CASE("the cycles on grids, with displacements alone and with pressures, are symmetric") {
  for (const bool over_elements : {false, true})
    for (const double contrast : {0.0, 1e9}) {
      CAPTURE(over_elements);
      CAPTURE(contrast);
      const Part part = over_elements ? bar(8, false, ElementType::hex8) : bar(4, false);
      const Space space(part);
      MultigridOptions options;
      options.pressure_contrast = options.element_contrast = contrast;
      options.grid_contrast = contrast;
      PartMultigrid multigrid(part, options);
      multigrid.setup(bent(part, 100.0), {}, space);
      const auto random = [&](double frequency) {
        Vector x(part.unknowns());
        for (std::size_t i = 0; i < x.size(); ++i)
          x[i] = part.held[i] ? 0.0
                              : std::sin(frequency * static_cast<double>(3 * part.node_index[i / 3]) +
                                         static_cast<double>(i % 3));
        return x;
      };
      const Vector x = random(0.7), y = random(1.9);
      Vector mx(x.size()), my(x.size());
      multigrid.apply(x, mx);
      multigrid.apply(y, my);
      const auto dot = [&](const Vector& a, const Vector& b) {
        return sum_all(std::inner_product(
            a.begin(), a.begin() + static_cast<std::ptrdiff_t>(part.owned_unknowns()), b.begin(), 0.0));
      };
      CHECK(dot(x, mx) > 0.0);
      CHECK(std::abs(dot(x, my) - dot(y, mx)) < 1e-4 * std::sqrt(dot(x, mx) * dot(y, my)));
    }
}

TEST_CASE("displacements alone take few iterations on grids, on every size" * doctest::skip(sanitized)) {
  const int small = iterations(bar(4, false), 1.0, 1e9), large = iterations(bar(8, false), 1.0, 1e9);
  CHECK(small <= 20);
  CHECK(large <= 20);
  CHECK(iterations(bar(6, true), 1.0, 1e9) <= 60);
}

TEST_CASE("its count hardly depends on k0/g, where that of modes alone does" * doctest::skip(sanitized)) {
  const Part small = bar(4, false), large = bar(8, false), graded = bar(6, true);
  const int least = iterations(small, 1.0);
  CHECK(least <= 20);
  CHECK(iterations(small, 1000.0) <= 26);
  CHECK(iterations(large, 1000.0) <= 26);
  CHECK(iterations(large, 1e4) <= 30);
  CHECK(iterations(graded, 1000.0) <= 60);
  CHECK(iterations(small, 1000.0, 1e9) > 60);
}
