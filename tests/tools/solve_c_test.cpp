// SPDX-License-Identifier: BSD-3-Clause
// The C solve interface: results and messages of the program, stops and restarts, no side effects on the
// host.
#include <doctest/doctest.h>
#include <kacanov/kacanov_solve.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

struct Destroy {
  void operator()(kacanov_solution* solution) const { kacanov_solution_destroy(solution); }
};
using Solution = std::unique_ptr<kacanov_solution, Destroy>;

struct Solved {
  int code = -1;
  std::string message;
  Solution solution;
};

kacanov_solve_options plain_options() {
  kacanov_solve_options options{};
  options.struct_size = sizeof options;
  options.threads = 1;
  return options;
}

Solved solved(const std::string& text, const kacanov_solve_options& options = plain_options()) {
  char message[512] = "";
  kacanov_solution* solution = nullptr;
  Solved out;
  out.code = kacanov_solve(text.c_str(), &options, &solution, message, sizeof message);
  out.message = message;
  out.solution.reset(solution);
  return out;
}

kacanov_solution_information about(const Solved& run) {
  kacanov_solution_information information{};
  information.struct_size = sizeof information;
  REQUIRE(kacanov_solution_inspect(run.solution.get(), &information) == KACANOV_OK);
  return information;
}

std::span<const double> field(const Solved& run, kacanov_field which) {
  std::size_t count = 0;
  const double* data = kacanov_solution_field(run.solution.get(), which, &count);
  return {data, count};
}

/// Checks that all numbers agree to 1e-12, except times and machine data.
void check_same(const nlohmann::json& a, const nlohmann::json& b, const std::string& path = "") {
  static const std::set<std::string> passing{"seconds", "peak_memory_bytes", "phases", "output"};
  INFO(path);
  if (a.is_object()) {
    REQUIRE(b.is_object());
    CHECK(a.size() == b.size());
    for (const auto& entry : a.items())
      if (!passing.contains(entry.key()))
        check_same(entry.value(), b.at(entry.key()), path + "." + entry.key());
  } else if (a.is_array()) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) check_same(a[i], b[i], path + "[" + std::to_string(i) + "]");
  } else if (a.is_number()) {
    const double value = a.get<double>();
    CHECK(std::abs(b.get<double>() - value) <= 1e-12 * std::abs(value));
  } else {
    CHECK(a == b);
  }
}

/// Returns the largest nodal displacement.
double largest(std::span<const double> u, std::size_t dim) {
  double most = 0.0;
  for (std::size_t n = 0; n < u.size(); n += dim) {
    double square = 0.0;
    for (std::size_t c = 0; c < dim; ++c) square += u[n + c] * u[n + c];
    most = std::max(most, std::sqrt(square));
  }
  return most;
}

}  // namespace

TEST_CASE("the numbers are the program's, and the arrays those of the result") {
  const Workplace place;
  nlohmann::json beam = small_beam();
  place.put_json("beam.json", beam);
  REQUIRE(place.run("run beam.json --ranks 1 --threads 1").exit_code == 0);
  const nlohmann::json program = place.json("results/beam/result.json");

  const Solved run = solved(beam.dump());
  INFO(run.message);
  REQUIRE(run.code == KACANOV_OK);
  const nlohmann::json result = parsed(kacanov_solution_json(run.solution.get()));
  check_same(program, result);

  const kacanov_solution_information information = about(run);
  CHECK(information.status == KACANOV_CONVERGED);
  CHECK(information.message == program["message"].get<std::string>());
  const auto u = field(run, KACANOV_FIELD_DISPLACEMENT);
  const std::size_t dim = information.dimension;
  REQUIRE(u.size() == information.nodes * dim);
  CHECK(field(run, KACANOV_FIELD_COORDINATES).size() == u.size());
  CHECK(field(run, KACANOV_FIELD_STRESS).size() == 6 * information.nodes);
  CHECK(largest(u, dim) ==
        doctest::Approx(program["max_displacement"]["value"].get<double>()).epsilon(1e-12));
  const auto von_mises = field(run, KACANOV_FIELD_ELEMENT_VON_MISES);
  REQUIRE(von_mises.size() == information.elements);
  CHECK(*std::max_element(von_mises.begin(), von_mises.end()) ==
        doctest::Approx(program["max_von_mises"].get<double>()).epsilon(1e-12));
  const auto pressure = field(run, KACANOV_FIELD_CONTACT_PRESSURE);
  REQUIRE(pressure.size() == information.contact_points);
  CHECK(*std::max_element(pressure.begin(), pressure.end()) ==
        doctest::Approx(program["max_contact_pressure"].get<double>()).epsilon(1e-12));

  std::size_t count = 0;
  const std::int32_t* plastic = kacanov_solution_indices(run.solution.get(), KACANOV_INDEX_PLASTIC, &count);
  REQUIRE(count == information.elements);
  CHECK(std::count(plastic, plastic + count, 1) == program["plastic_elements"].get<std::int64_t>());
  const std::int32_t* status =
      kacanov_solution_indices(run.solution.get(), KACANOV_INDEX_CONTACT_STATUS, &count);
  REQUIRE(count == information.contact_points);
  CHECK(std::count(status, status + count, 2) == program["slip_nodes"].get<std::int64_t>());
  CHECK(std::count_if(pressure.begin(), pressure.end(), [](double p) { return p > 0.0; }) ==
        program["active_nodes"].get<std::int64_t>());
  const std::int64_t* numbers = kacanov_solution_numbers(run.solution.get(), 0, &count);
  REQUIRE(count == information.nodes);
  CHECK(numbers[0] == 1);
  CHECK(kacanov_solution_field(run.solution.get(), 99, &count) == nullptr);
  CHECK(count == 0);
}

TEST_CASE("a case that is wrong is refused in the words of its file") {
  nlohmann::json beam = small_beam();
  beam["material"][0]["poisson"] = 0.7;
  Solved run = solved(beam.dump());
  CHECK(run.code == KACANOV_ERROR_CASE);
  CHECK(run.message.find("material[0].poisson: expected") == 0);
  CHECK(run.solution == nullptr);

  run = solved("{\n  \"mesh\": }");
  CHECK(run.code == KACANOV_ERROR_CASE);
  CHECK(run.message.find("case.json:2:") == 0);

  kacanov_solve_options options = plain_options();
  options.folder = "/no/such";
  options.name = "rod";
  run = solved(R"({"mesh": {"file": "rod.msh"}, "material": [], "boundary": []})", options);
  CHECK(run.code == KACANOV_ERROR_CASE);

  options.threads = -1;
  run = solved(small_beam().dump(), options);
  CHECK(run.code == KACANOV_ERROR_VALUE);
  CHECK(run.message.find("options.threads") == 0);
  options.struct_size = 3;
  CHECK(solved(small_beam().dump(), options).code == KACANOV_ERROR_SIZE);
  kacanov_solution* solution = nullptr;
  CHECK(kacanov_solve(nullptr, nullptr, &solution, nullptr, 0) == KACANOV_ERROR_NULL);
  CHECK(kacanov_solve("{}", nullptr, nullptr, nullptr, 0) == KACANOV_ERROR_NULL);
}

TEST_CASE("relative paths start at the folder, and a mesh may be in memory") {
  const Workplace place;
  const std::string mesh =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"base\"\n3 2 \"body\"\n"
      "$EndPhysicalNames\n$Nodes\n4\n11 0 0 0\n12 1 0 0\n13 0 1 0\n14 0 0 1\n$EndNodes\n$Elements\n2\n"
      "1 2 2 1 1 11 13 12\n7 4 2 2 1 11 12 13 14\n$EndElements\n";
  place.put("one.msh", mesh);
  const nlohmann::json document = {
      {"mesh", {{"file", "one.msh"}}},
      {"material", {{{"on", "all"}, {"young", 1.0}, {"poisson", 0.3}, {"law", {{"type", "linear"}}}}}},
      {"boundary",
       {{{"on", "base"}, {"displacement", {0, 0, 0}}}, {{"on", "all"}, {"body_force", {0, 0, -0.1}}}}}};
  kacanov_solve_options options = plain_options();
  const std::string folder = place.path("").string();
  options.folder = folder.c_str();
  const Solved from_file = solved(document.dump(), options);
  INFO(from_file.message);
  REQUIRE(from_file.code == KACANOV_OK);

  options.folder = "/no/such";
  options.mesh = mesh.data();
  options.mesh_size = mesh.size();
  const Solved from_memory = solved(document.dump(), options);
  INFO(from_memory.message);
  REQUIRE(from_memory.code == KACANOV_OK);
  const auto a = field(from_file, KACANOV_FIELD_DISPLACEMENT),
             b = field(from_memory, KACANOV_FIELD_DISPLACEMENT);
  CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  CHECK(largest(a, 3) > 0.0);
  const std::int64_t* nodes = kacanov_solution_numbers(from_file.solution.get(), 0, nullptr);
  REQUIRE(nodes != nullptr);
  CHECK(nodes[0] == 11);
  CHECK(kacanov_solution_numbers(from_file.solution.get(), 1, nullptr)[0] == 7);
}

namespace {

/// A host that records progress, requests a stop after some steps, and tries to solve from a callback.
struct Watcher {
  std::vector<double> residuals;
  int last = 1 << 30, code_within = KACANOV_OK;
  static void tell(void* data, const kacanov_progress* step) {
    auto& self = *static_cast<Watcher*>(data);
    self.residuals.push_back(step->worst_residual);
    kacanov_solution* other = nullptr;
    self.code_within = kacanov_solve("{}", nullptr, &other, nullptr, 0);
  }
  static int stop(void* data) {
    const auto& self = *static_cast<Watcher*>(data);
    return static_cast<int>(self.residuals.size()) >= self.last;
  }
};

}  // namespace

TEST_CASE("progress is told, a stop leaves the state so far, and a later run goes on from it") {
  const std::string text = small_beam().dump();
  Watcher watcher;
  kacanov_solve_options options = plain_options();
  options.progress = Watcher::tell;
  options.stop = Watcher::stop;
  options.data = &watcher;
  const Solved whole = solved(text, options);
  REQUIRE(whole.code == KACANOV_OK);
  CHECK(watcher.code_within == KACANOV_ERROR_STATE);
  REQUIRE(watcher.residuals.size() > 2);
  CHECK(watcher.residuals.back() == doctest::Approx(about(whole).worst_residual).epsilon(1e-6));

  Watcher impatient;
  impatient.last = 1;
  options.data = &impatient;
  const Solved stopped = solved(text, options);
  REQUIRE(stopped.code == KACANOV_OK);
  CHECK(about(stopped).status == KACANOV_INTERRUPTED);
  CHECK(impatient.residuals.size() < watcher.residuals.size());
  CHECK(largest(field(stopped, KACANOV_FIELD_DISPLACEMENT), 2) > 0.0);

  Watcher resumed;
  options.data = &resumed;
  options.start = whole.solution.get();
  const Solved again = solved(text, options);
  REQUIRE(again.code == KACANOV_OK);
  CHECK(about(again).status == KACANOV_CONVERGED);
  CHECK(resumed.residuals.size() < watcher.residuals.size());
}

TEST_CASE("a host finds its environment, signals and locale as they were, and threads wait for each other") {
  const auto environment = [] {
    std::set<std::string> all;
    for (char** entry = environ; *entry != nullptr; ++entry) all.insert(*entry);
    return all;
  };
  const auto handlers = [] {
    std::vector<void (*)(int)> all;
    for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGCHLD, SIGUSR1, SIGPIPE}) {
      struct sigaction action {};
      sigaction(signal, nullptr, &action);
      all.push_back(action.sa_handler);
    }
    return all;
  };
  const auto variables = environment();
  const auto before = handlers();
  const std::string text = small_beam().dump();
  std::vector<Solved> runs(3);
  std::vector<std::thread> threads;
  for (Solved& run : runs) threads.emplace_back([&] { run = solved(text); });
  for (std::thread& thread : threads) thread.join();
  CHECK(environment() == variables);
  CHECK(handlers() == before);
  for (const Solved& run : runs) {
    REQUIRE(run.code == KACANOV_OK);
    const auto a = field(runs[0], KACANOV_FIELD_DISPLACEMENT), b = field(run, KACANOV_FIELD_DISPLACEMENT);
    CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
}

TEST_CASE("structs of other versions are read and written by their size") {
  struct {
    kacanov_solve_options known = plain_options();
    std::int64_t more = 0;
  } options;
  options.known.struct_size = sizeof options;
  const std::string text = small_beam().dump();
  CHECK(solved(text, options.known).code == KACANOV_OK);
  options.more = 1;
  CHECK(solved(text, options.known).code == KACANOV_ERROR_VALUE);
  kacanov_solution_information information{};
  CHECK(kacanov_solution_inspect(solved(text).solution.get(), &information) == KACANOV_ERROR_SIZE);
}
