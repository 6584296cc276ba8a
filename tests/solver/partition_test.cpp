// SPDX-License-Identifier: BSD-3-Clause
// Any number of ranks: partitioning, scatter and gather against their definitions, the same answer as on one
// rank; parts with inconsistent fields are named.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include <kacanov/error.hpp>
#include <kacanov/scatterer.hpp>
#include "../sanitized.hpp"
#include "linear/space.hpp"
#include "parallel/exchange.hpp"
#include "partition/check_part.hpp"
#include "preconditioners.hpp"
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace {

Problem beam_problem(int dim, int n, double tresca = 0.0) {
  return build_problem(beam_mesh(dim, n), beam(dim, logarithmic_law(0.01), 0.05, tresca));
}

/// A value that identifies a node of the mesh, wherever it is stored.
double signature(std::int64_t node, int component) {
  return std::sin(static_cast<double>(node)) + 10.0 * component;
}

}  // namespace

TEST_CASE("every element lies on one rank, every node has one owner") {
  const Problem problem = beam_problem(3, 3);
  Part part = over_all_ranks(problem);
  std::vector<int> elements(problem.mesh.element_count(), 0), owners(problem.mesh.node_count(), 0),
      points(problem.contact.size(), 0);
  for (std::size_t e = 0; e < part.element_count(); ++e) ++elements[part.element_index[e]];
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_nodes()); ++i) ++owners[part.node_index[i]];
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i)
    ++points[part.contact_index[i]];
  for (auto* count : {&elements, &owners, &points}) {
    MPI_Allreduce(MPI_IN_PLACE, count->data(), static_cast<int>(count->size()), MPI_INT, MPI_SUM,
                  MPI_COMM_WORLD);
    CHECK(std::all_of(count->begin(), count->end(), [](int c) { return c == 1; }));
  }
  CHECK(part.total_elements == static_cast<std::int64_t>(problem.mesh.element_count()));
  CHECK(part.total_nodes() == static_cast<std::int64_t>(problem.mesh.node_count()));
  CHECK(part.total_contact == static_cast<std::int64_t>(problem.contact.size()));

  // The part is the mesh seen through its index arrays.
  const std::size_t npe = nodes_per_element(part.type);
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    const std::size_t e = part.element_index[k / npe];
    if (part.node_index[part.elements[k]] != problem.mesh.elements[e * npe + k % npe]) ++wrong;
  }
  std::vector<double> load(part.unknowns());
  part.add_load(load);
  for (std::size_t i = 0; i < part.unknowns(); ++i) {
    const std::size_t there = 3 * static_cast<std::size_t>(part.node_index[i / 3]) + i % 3;
    if (part.coordinates[i] != problem.mesh.coordinates[there] || load[i] != problem.load[there] ||
        part.held[i] != problem.held[there] ||
        (part.held[i] != 0 && part.prescribed[part.prescribed_place(i)].value != problem.prescribed[there]))
      ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("owned nodes are numbered on through the ranks, and ghosts know their owners' numbers") {
  const Problem problem = beam_problem(2, 4);
  Part part = over_all_ranks(problem);
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_nodes()); ++i)
    CHECK(part.node_number(i) == part.node_map.first() + static_cast<std::int64_t>(i));
  std::vector<std::int64_t> number(part.nodes());
  for (std::size_t i = 0; i < part.nodes(); ++i) number[i] = part.node_number(i);
  const std::vector<std::int64_t> expected = number;
  for (std::size_t i = part.owned_nodes(); i < part.nodes(); ++i) number[i] = -1;
  part.node_map.forward(number, 1);
  CHECK(number == expected);
}

TEST_CASE("a map made from ghosts' numbers finds their owners, numbers beyond 2^53 included") {
  const Communicator world = mpi_communicator(MPI_COMM_WORLD);
  // Each rank owns three more than the previous one and requests the first and last of every other rank.
  const std::int32_t owned = 3 * world.rank + 2;
  const std::vector<std::int64_t> starts = number_owned(owned, world);
  std::vector<std::int64_t> ghosts;
  for (int r = 0; r < world.ranks; ++r) {
    if (r == world.rank) continue;
    ghosts.push_back(starts[r]);
    ghosts.push_back(starts[static_cast<std::size_t>(r) + 1] - 1);
  }
  const IndexMap map = make_index_map(world, owned, ghosts);
  CHECK(map.total() == world.sum_all(std::int64_t{owned}));
  CHECK(map.first() == world.sum_below(owned));
  for (std::size_t i = 0; i < map.size(); ++i) {
    const int owner = map.owner(map.number(i));
    CHECK((owner == world.rank) == (i < static_cast<std::size_t>(owned)));
  }
  constexpr std::int64_t large = (std::int64_t{1} << 60) + 1;  // not representable as a double
  std::vector<std::int64_t> value(2 * map.size(), -1);
  for (std::size_t i = 0; i < 2 * static_cast<std::size_t>(owned); ++i)
    value[i] = large + 2 * map.first() + static_cast<std::int64_t>(i);
  map.forward(value, 2);
  for (std::size_t i = 0; i < map.size(); ++i)
    for (std::size_t c = 0; c < 2; ++c)
      CHECK(value[2 * i + c] == large + 2 * map.number(i) + static_cast<std::int64_t>(c));
}

TEST_CASE("a sum in two halves is the whole one, whatever happens elsewhere in between") {
  const Problem problem = beam_problem(3, 2);
  Part part = over_all_ranks(problem);
  Scatterer<float> sum(part.node_map, 3);
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<float> x(3 * part.nodes()), whole;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = static_cast<float>(signature(part.node_index[i / 3], static_cast<int>(i % 3)) *
                                (1.0 + 0.3 * part.node_map.rank + turn));
    whole = x;
    part.node_map.sum(whole, 3);
    sum.start_sum(x);
    std::vector<char> is_shared(part.nodes(), 0);
    for (const std::int32_t node : part.node_map.shared) is_shared[node] = 1;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (is_shared[i / 3] == 0) x[i] = whole[i] = static_cast<float>(turn);
    sum.finish_sum(x);
    CHECK(x == whole);
  }
}

TEST_CASE("sums over shared nodes count the ranks that share a node, with the same bits on each") {
  const Problem problem = beam_problem(3, 2);
  Part part = over_all_ranks(problem);
  // Each rank adds a number that is rounded: another order of summation would change the last bits.
  std::vector<double> x(2 * part.nodes());
  for (std::size_t i = 0; i < part.nodes(); ++i) {
    x[2 * i] = 1.0;
    x[2 * i + 1] = 0.1 * (1 + part.node_map.rank) * (1.0 + signature(part.node_index[i], 0));
  }
  part.node_map.sum(x, 2);
  // All copies, gathered by mesh node.
  const std::size_t nodes = problem.mesh.node_count();
  std::vector<double> sharers(nodes, 0.0), largest(nodes, -1e300), smallest(nodes, 1e300);
  for (std::size_t i = 0; i < part.nodes(); ++i) {
    const std::size_t n = part.node_index[i];
    sharers[n] = 1.0;
    largest[n] = smallest[n] = x[2 * i + 1];
  }
  MPI_Allreduce(MPI_IN_PLACE, sharers.data(), static_cast<int>(nodes), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), static_cast<int>(nodes), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, smallest.data(), static_cast<int>(nodes), MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
  CHECK(std::memcmp(largest.data(), smallest.data(), nodes * sizeof(double)) == 0);
  for (std::size_t i = 0; i < part.nodes(); ++i) CHECK(x[2 * i] == sharers[part.node_index[i]]);
  // `shared` lists exactly the nodes with more than one copy.
  std::vector<std::int32_t> listed = part.node_map.shared, found;
  for (std::size_t i = 0; i < part.nodes(); ++i)
    if (x[2 * i] > 1.5) found.push_back(static_cast<std::int32_t>(i));
  std::sort(listed.begin(), listed.end());
  CHECK(listed == found);
}

TEST_CASE("reductions over the ranks") {
  const Problem problem = beam_problem(2, 2);
  const IndexMap nodes = over_all_ranks(problem).node_map;
  const int n = nodes.ranks;
  CHECK(nodes.sum_all(1.0 + nodes.rank) == 0.5 * n * (n + 1));
  CHECK(nodes.sum_all(std::int64_t{1} << 40) == n * (std::int64_t{1} << 40));
  CHECK(nodes.max_all(-1.0 - nodes.rank) == -1.0);
  std::array<double, 2> pair{1.0, static_cast<double>(nodes.rank)};
  nodes.sum_all(pair);
  CHECK(pair[0] == n);
  CHECK(pair[1] == 0.5 * n * (n - 1));
}

TEST_CASE("gathers return to the numbering of the problem") {
  const Problem problem = beam_problem(3, 2);
  Part part = over_all_ranks(problem);
  std::vector<double> nodal(2 * part.nodes()), contact(3 * part.contact.size());
  for (std::size_t i = 0; i < nodal.size(); ++i)
    nodal[i] = signature(part.node_index[i / 2], static_cast<int>(i % 2));
  for (std::size_t i = 0; i < contact.size(); ++i)
    contact[i] = signature(part.contact_index[i / 3], static_cast<int>(i % 3));
  const auto all_nodal = gather_nodal(part, nodal, 2);
  const auto all_contact = gather_contact(part, contact, 3);
  if (part.node_map.rank > 0) {
    CHECK(all_nodal.empty());
    CHECK(all_contact.empty());
    return;
  }
  REQUIRE(all_nodal.size() == 2 * problem.mesh.node_count());
  REQUIRE(all_contact.size() == 3 * problem.contact.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < all_nodal.size(); ++i)
    wrong += all_nodal[i] != signature(static_cast<std::int64_t>(i / 2), static_cast<int>(i % 2));
  for (std::size_t i = 0; i < all_contact.size(); ++i)
    wrong += all_contact[i] != signature(static_cast<std::int64_t>(i / 3), static_cast<int>(i % 3));
  CHECK(wrong == 0);
}

TEST_CASE("multigrid over the ranks is symmetric, positive definite and consistent") {
  const Problem problem = beam_problem(3, 3);
  Part part = over_all_ranks(problem);
  const Space space(part);
  std::vector<double> g(part.body().secant_count());
  reference::secant(part.body(), std::vector<double>(part.unknowns(), 0.0), g);
  Vector x(part.unknowns()), y(part.unknowns()), mx(part.unknowns()), my(part.unknowns());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = signature(part.node_index[i / 3], static_cast<int>(i % 3));
    y[i] = signature(7 * part.node_index[i / 3] + 1, static_cast<int>(2 - i % 3));
  }
  space.project(x);
  space.project(y);
  for (const char* kind : {"multigrid", "elasticity", "factor"}) {
    CAPTURE(kind);
    const auto amg = preconditioner_named(kind, part);
    amg->setup(g, {}, space);
    amg->apply(x, mx);
    amg->apply(y, my);
    // Multigrid uses single precision.
    const double rounding = std::string(kind) == "multigrid" ? 1e-5 : 1e-10;
    CHECK(std::abs(space.dot(mx, y) - space.dot(x, my)) <=
          rounding * std::sqrt(space.dot(mx, x) * space.dot(my, y)));
    CHECK(space.dot(mx, x) > 0.0);
    Vector copy = mx;
    part.node_map.forward(copy, 3);
    CHECK(copy == mx);
  }
}

TEST_CASE("the spectrum does not depend on the partition" * doctest::skip(sanitized)) {
  for (const int dim : {2, 3}) {
    const Problem problem = beam_problem(dim, dim == 2 ? 8 : 3, 0.01);
    SolverOptions options;
    options.spectrum_tolerance = 1e-7;
    const auto all = analyse_spectrum(over_all_ranks(problem), options, {});
    const auto alone = analyse_spectrum(distribute(&problem, MPI_COMM_SELF), options, {});
    REQUIRE(all.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(all[i].lambda_min == doctest::Approx(alone[i].lambda_min).epsilon(1e-6));
      CHECK(all[i].lambda_max == doctest::Approx(alone[i].lambda_max).epsilon(1e-6));
      CHECK(all[i].traces == alone[i].traces);
    }
  }
}

TEST_CASE("one contact node: the other ranks have no rows") {
  Model model = elastic_model();
  model.boundary.push_back(moved(box({0.3, -1, -1}, {4, 1, 1}), 2));
  model.contact.push_back(on_plane(named("left"), {-0.1, 0, 0}, {1, 0, 0}));
  model.boundary.push_back(moved(box({0, 0.5, 0}, {4, 1, 0}), 2));
  const Problem problem = build_problem(make_box({{4, 1, 1}, {16, 4, 1}, ElementType::tri3}), model);
  SolverOptions options;
  options.spectrum_tolerance = 1e-6;
  const auto all = analyse_spectrum(over_all_ranks(problem), options, {});
  const auto alone = analyse_spectrum(distribute(&problem, MPI_COMM_SELF), options, {});
  CHECK(all[0].lambda_max == doctest::Approx(alone[0].lambda_max).epsilon(1e-5));
  CHECK(all[0].lambda_min == doctest::Approx(alone[0].lambda_min).epsilon(1e-5));
}

TEST_CASE("the answer does not depend on the partition or on threads") {
  struct Case {
    int dim, n;
    double tresca;
  };
  for (const Case& each : {Case{2, 8, 0.0}, Case{2, 8, 0.01}, Case{3, 3, 0.01}}) {
    CAPTURE(each.dim);
    CAPTURE(each.tresca);
    const Problem problem = beam_problem(each.dim, each.n, each.tresca);
    SolverOptions options;
    options.tolerance = 1e-8;
    Part all = over_all_ranks(problem), alone = distribute(&problem, MPI_COMM_SELF);
    const Solution reference = solve(alone, options, {});
    REQUIRE(reference.result.status == Status::converged);
    for (const int threads : {1, 2}) {
      RunOptions run;
      run.threads = threads;
      const Solution solution = solve(all, options, run);
      const Result& result = solution.result;
      CHECK(result.status == Status::converged);
      CHECK(result.ranks == all.node_map.ranks);
      CHECK(result.threads == threads);
      CHECK(distance(result.probe.at(0), reference.result.probe.at(0)) <
            1e-6 * length(reference.result.probe.at(0)));
      CHECK(distance(result.contact_force, reference.result.contact_force) <
            1e-6 * length(reference.result.contact_force));
      CHECK(distance(result.friction_force, reference.result.friction_force) <
            1e-5 * length(reference.result.contact_force));
      CHECK(std::abs(result.active_nodes - reference.result.active_nodes) <= 1);
      CHECK(std::abs(result.slip_nodes - reference.result.slip_nodes) <= 1);
      CHECK(std::abs(result.plastic_elements - reference.result.plastic_elements) <= 1);
      CHECK(result.elements == reference.result.elements);
      CHECK(result.unknowns == reference.result.unknowns);
      // All copies of a shared displacement are bitwise equal.
      std::vector<double> copy = solution.displacement;
      all.node_map.forward(copy, each.dim);
      CHECK(std::memcmp(copy.data(), solution.displacement.data(), copy.size() * sizeof(double)) == 0);
    }
  }
}

TEST_CASE("progress is told on rank 0 only") {
  const Problem problem = beam_problem(2, 4);
  Part part = over_all_ranks(problem);
  RunOptions run;
  int lines = 0;
  run.progress = [&](const ProgressStep&) { ++lines; };
  const Solution solution = solve(part, {}, run);
  if (part.node_map.rank == 0)
    CHECK(lines >= solution.result.outer_iterations);
  else
    CHECK(lines == 0);
}

TEST_CASE("what is wrong on one rank is thrown on all") {
  const Communicator ranks = mpi_communicator(MPI_COMM_WORLD);
  CHECK_NOTHROW(refuse_together("", ranks));
  const std::string text = ranks.rank == ranks.ranks - 1 ? "the last one has it" : "";
  CHECK_THROWS_WITH_AS(refuse_together(text, ranks), "the last one has it", InputError);
}

#ifdef KACANOV_CHECK_COLLECTIVES
TEST_CASE("ranks at different collective calls all learn both places, and can continue") {
  Part part = over_all_ranks(beam_problem(3, 3));
  const Communicator& ranks = part.node_map;
  if (ranks.ranks == 1) return;
  const auto message_of = [&](const auto& first, const auto& others) -> std::string {
    try {
      ranks.rank == 0 ? first() : others();
    } catch (const std::logic_error& error) {
      return error.what();
    }
    return {};
  };
  const auto names = [](const std::string& message, int line, int other) {
    const auto place = [](int at) { return "solver/partition_test.cpp:" + std::to_string(at) + " "; };
    return message.find("rank 0 is at " + place(line)) != std::string::npos &&
           message.find("rank 1 at " + place(other)) != std::string::npos;
  };
  const int line = __LINE__;
  const auto sum = [&] { ranks.sum_all(1.0); };
  const auto largest = [&] { ranks.any(true); };
  std::vector<double> x(part.nodes(), 1.0);
  const auto scatter = [&] { part.node_map.forward(x, 1); };
  CHECK(names(message_of(sum, largest), line + 1, line + 2));
  CHECK(names(message_of(scatter, sum), line + 4, line + 1));
  CHECK(message_of(sum, sum).empty());
  CHECK(message_of(scatter, scatter).empty());
  // Sums of several numbers, with a different count on one rank.
  std::vector<double> some(ranks.rank == 0 ? 3 : 2, 1.0);
  const auto sums = [&] { ranks.sum_all(some); };
  CHECK(message_of(sums, sums).find("2 entries") != std::string::npos);
  CHECK(ranks.sum_all(std::int64_t{1}) == ranks.ranks);
}
#endif

namespace {

/// Returns the message of check_part for a changed part, empty if it accepts the part.
std::string complaint(Part part, const std::function<void(Part&)>& change) {
  const int rank = part.node_map.rank, ranks = part.node_map.ranks;
  change(part);
  try {
    check_part(part, rank, ranks);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a part that was split is accepted, and each field that does not fit is named") {
  const Problem problem = build_problem(beam_mesh(2, 8), beam(2, logarithmic_law(0.01), 0.05, 0.1));
  for (const int ranks : {1, 3})
    split(problem, ranks, [&](int, Part&& part) {
      CHECK(complaint(part, [](Part&) {}) == "");
      const std::pair<const char*, std::function<void(Part&)>> faults[] = {
          {"elements", [](Part& p) { p.elements[4] = 1 << 30; }},
          {"elements", [](Part& p) { p.elements[0] = -5; }},
          {"elements", [](Part& p) { p.elements.pop_back(); }},
          {"element type", [](Part& p) { p.type = static_cast<ElementType>(77); }},
          {"coordinates", [](Part& p) { p.coordinates.pop_back(); }},
          {"element numbers", [](Part& p) { p.element_index.runs[0].position = 3; }},
          {"node map", [](Part& p) { p.node_map.owned = 1 << 20; }},
          {"first nodes", [](Part& p) { p.node_map.starts.pop_back(); }},
          {"neighbours",
           [](Part& p) {
             p.node_map.neighbours.push_back({p.node_map.rank, {}, {}, {}});
           }},
          {"shared nodes", [](Part& p) { p.node_map.shared.push_back(1 << 28); }},
          {"node numbers", [](Part& p) { p.node_index[0] = 1 << 29; }},
          {"laws", [](Part& p) { p.laws.clear(); }},
          {"laws of elements", [](Part& p) { p.law_of_element.assign(p.element_count(), 7); }},
          {"loads",
           [](Part& p) {
             p.load.push_back({1 << 29, 1.0});
           }},
          {"held components", [](Part& p) { p.held.pop_back(); }},
          {"prescribed components",
           [](Part& p) {
             p.prescribed.push_back({1 << 29, 1.0});
           }},
          {"held directions",
           [](Part& p) {
             p.directions.push_back({1 << 29, 0, {0, 1, 0}, 0.0});
           }},
          {"held directions",
           [](Part& p) {
             p.directions.assign(4, {1, 0, {0, 1, 0}, 0.0});
           }},
          {"held directions",
           [](Part& p) {
             p.directions.push_back({1, 0, {3, 1, 0}, 0.0});
           }},
          {"springs",
           [](Part& p) {
             p.springs.push_back({-1, 0, {}});
           }},
          {"springs",
           [](Part& p) {
             p.springs.push_back({0, 1 << 29, {}});
           }},
          {"springs",
           [](Part& p) {
             p.springs = {{2, 0, {}}, {1, 0, {}}};
           }},
          {"temperatures",
           [](Part& p) {
             p.thermal.push_back({0, {1.0}});
           }},
          {"start", [](Part& p) { p.start.assign(3, 0.0); }},
          {"numbers of probes", [](Part& p) { p.probe_index.push_back(0); }},
          {"numbers of contact points", [](Part& p) { p.contact_index.push_back(0); }},
          {"contact points", [](Part& p) { p.owned_contact = 1 << 20; }},
      };
      for (const auto& [field, change] : faults) {
        const std::string name = field;
        CAPTURE(name);
        CHECK(complaint(part, change).find("the part's " + name) == 0);
      }
      if (!part.contact.empty()) {
        CHECK(complaint(part, [](Part& p) { p.contact[0].node = 1 << 28; }) != "");
        CHECK(complaint(part, [](Part& p) { p.contact[0].tangents = 9; }) != "");
        CHECK(complaint(part, [](Part& p) { p.contact[0].entry = -1; }) != "");
      }
    });
}

TEST_CASE("a checkpoint's counts are whole and in range") {
  Checkpoint checkpoint;
  for (const double wrong : {-1.0, 0.5, 3.0, 1e18, std::numeric_limits<double>::quiet_NaN()}) {
    checkpoint.numbers["load_steps_over"] = wrong;
    CHECK_THROWS_AS(checkpoint.count("load_steps_over", 2), InputError);
  }
  checkpoint.numbers["load_steps_over"] = 2.0;
  CHECK(checkpoint.count("load_steps_over", 2) == 2);
  CHECK_THROWS_AS(checkpoint.count("missing", 2), InputError);
}
