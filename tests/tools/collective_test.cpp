// SPDX-License-Identifier: BSD-3-Clause
// Cases with features that only some ranks have, on 1 to 8 ranks: the same answer, and no deadlock.
#include <doctest/doctest.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include "program/parallel.hpp"
#include "program/solve_case.hpp"

using namespace kacanov;
using nlohmann::json;

namespace {

constexpr unsigned most_seconds = 240;  ///< limit per solve, which takes one: machines may be busy
std::string at_work;                    ///< the current solve, for the message about a hang

void say_what_hangs(int) {
  for (const char* text : {"no end of: ", at_work.c_str(), "\n"})
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  _exit(1);
}

bool is_flat(const std::string& element) { return element == "tri3" || element == "quad4"; }

/// A bar loaded at its right end; additions are on one side of its middle.
json bar(const std::string& element, bool small = false) {
  json input = json::parse(R"({
    "mesh": {"box": {"size": [1.2, 1, 1], "cells": [6, 2, 2]}},
    "material": [{"on": "all", "young": 1, "poisson": 0.3},
                 {"on": {"box": [[0.599, 0, 0], [1.2, 1, 1]]}, "young": 1, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]},
                 {"on": "right", "traction": [0, 0, -0.01]}],
    "solver": {"tolerance": 1e-8},
    "probe": [[1.2, 0.5, 0.5]]
  })");
  input["mesh"]["box"]["element"] = element;
  if (small) input["mesh"]["box"]["cells"] = {3, 1, 1};
  if (!is_flat(element)) return input;
  input["mesh"]["box"].update({{"size", {1.2, 1}}, {"cells", {6, 3}}});
  if (small) input["mesh"]["box"]["cells"] = {4, 2};
  input["material"][1]["on"] = {{"box", {{0.599, 0}, {1.2, 1}}}};
  input["boundary"][0]["displacement"] = {0, 0};
  input["boundary"][1]["traction"] = {0, -0.01};
  input["probe"] = {{1.2, 0.5}};
  return input;
}

bool is_flat(const json& input) { return is_flat(input["mesh"]["box"]["element"].get<std::string>()); }

/// An optional feature of the bar, on one side of its middle.
struct Addition {
  const char* name;
  void (*to)(json& input);
};

const std::vector<Addition> formulations{
    {"plain", [](json&) {}},
    {"mixed", [](json& input) { input["material"][1]["formulation"] = "mixed"; }},
    {"nearly incompressible",
     [](json& input) {
       input["material"][1]["poisson"] = 0.4999;
       if (!is_flat(input)) input["material"][1]["formulation"] = "mixed";
     }},
    {"two bulk moduli",
     [](json& input) {
       for (json& material : input["material"]) material["formulation"] = "mixed";
       input["material"][1]["young"] = 3;
     }},
};
const std::vector<Addition> others{
    {"", [](json&) {}},
    {"plastic",
     [](json& input) {
       input["material"][1]["law"] = {{"type", "logarithmic"}, {"x0", 0.005}};
     }},
    {"warm",
     [](json& input) {
       input["material"][1]["expansion"] = 0.001;
       input["boundary"].push_back({{"on", input["material"][1]["on"]}, {"temperature", 5}});
     }},
    {"contact",
     [](json& input) {
       const bool flat = is_flat(input);
       const json corner = flat ? json{0.799, -0.001} : json{0.799, -0.001, -0.001},
                  other = flat ? json{1.201, 0.001} : json{1.201, 1.001, 0.001};
       input["contact"] = {{{"on", {{"box", {corner, other}}}},
                            {"obstacle",
                             {{"plane",
                               {{"point", flat ? json{0, 0} : json{0, 0, 0}},
                                {"normal", flat ? json{0, 1} : json{0, 0, 1}}}}}},
                            {"friction", {{"coulomb", 0.3}}}}};
     }},
    {"spring",
     [](json& input) {
       input["boundary"].push_back({{"on", "right"}, {"spring", 0.01}});
     }},
    {"slanting",
     [](json& input) {
       const json frame = is_flat(input) ? json{{1, 1}, {-1, 1}} : json{{1, 0, 1}, {0, 1, 0}, {-1, 0, 1}};
       json on = is_flat(input) ? json{{1.199, -0.001}, {1.201, 0.35}}
                                : json{{1.199, -0.001, -0.001}, {1.201, 1.001, 0.51}};
       json displacement = is_flat(input) ? json{nullptr, 0} : json{nullptr, nullptr, 0};
       input["boundary"].push_back({{"on", {{"box", on}}}, {"frame", frame}, {"displacement", displacement}});
     }},
    {"load steps", [](json& input) { input["solver"]["load_steps"] = 2; }},
};

/// Results that must agree between two runs, on the first rank.
struct Answer {
  std::string status;
  std::vector<double> displacement, von_mises, pressure;
};

/// Solves the case on the ranks of `comm`; the status is "refused" if there are too few elements.
Answer solve_on(const json& input, MPI_Comm comm) {
  const MpiSession mpi(comm);
  try {
    const SolvedCase solved = solve_case(parse_case(input, "."), mpi, {});
    return {solved.json["status"], solved.displacement, solved.recovered_von_mises, solved.contact.pressure};
  } catch (const InputError& error) {
    if (std::strstr(error.what(), "cannot be split into") == nullptr) throw;
    return {"refused", {}, {}, {}};
  }
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return HUGE_VAL;
  double largest = 0.0, off = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(b[i]));
    off = std::max(off, std::abs(a[i] - b[i]));
  }
  return off / std::max(largest, 1e-300);
}

/// Runs `work` on the first ranks while the others sleep, because waiting ranks would occupy the cores.
template <class Work>
void on_first(int ranks, const Work& work) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm some = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, rank < ranks ? 0 : MPI_UNDEFINED, rank, &some);
  if (rank < ranks) work(some);
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  for (int over = 0; MPI_Test(&all, &over, MPI_STATUS_IGNORE), over == 0;) usleep(1000);
  if (some != MPI_COMM_NULL) MPI_Comm_free(&some);
}

int world_size() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

bool is_first() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

/// Compares the answer of a case on several numbers of ranks with that on one rank.
void check_ranks(const std::string& name, const json& input, const std::vector<int>& numbers, bool small) {
  INFO(name);
  signal(SIGALRM, say_what_hangs);
  Answer alone;
  on_first(1, [&](MPI_Comm) {
    at_work = name + " on one rank";
    alarm(most_seconds);
    alone = solve_on(input, MPI_COMM_SELF);
    CHECK(alone.status == "converged");
  });
  for (const int ranks : numbers) {
    if (ranks > world_size()) continue;
    on_first(ranks, [&](MPI_Comm comm) {
      at_work = name + " on " + std::to_string(ranks) + " ranks";
      alarm(most_seconds);
      const Answer now = solve_on(input, comm);
      if (!is_first() || (small && now.status == "refused")) return;
      CAPTURE(ranks);
      CHECK(now.status == "converged");
      CHECK(distance(now.displacement, alone.displacement) < 1e-6);
      CHECK(distance(now.von_mises, alone.von_mises) < 1e-4);
      CHECK(distance(now.pressure, alone.pressure) < 1e-4);
    });
  }
  alarm(0);
}

std::string mixed_name(const std::string& element, const Addition& formulation, const Addition& other) {
  return element + ", " + formulation.name + (*other.name != '\0' ? std::string(", ") + other.name : "");
}

void check_mix(const std::string& element, std::size_t formulation, std::size_t other,
               const std::vector<int>& numbers, bool small = false) {
  json input = bar(element, small);
  formulations[formulation].to(input);
  others[other].to(input);
  check_ranks(mixed_name(element, formulations[formulation], others[other]) + (small ? ", few elements" : ""),
              input, numbers, small);
}

}  // namespace

TEST_CASE("mixes of formulations with all else on one side, on some numbers of ranks") {
  // Each formulation with each element type that supports it, and each addition, once or twice.
  check_mix("tet10", 1, 0, {2, 3, 4, 5});
  check_mix("tet10", 2, 1, {4});
  check_mix("tet10", 3, 3, {8});
  check_mix("tet4", 1, 3, {4});
  check_mix("tet4", 2, 4, {8});
  check_mix("tet4", 3, 2, {3});
  check_mix("hex8", 1, 1, {4});
  check_mix("hex8", 2, 5, {8});
  check_mix("tri3", 0, 3, {8});
  check_mix("quad4", 2, 5, {4});
  check_mix("quad4", 0, 2, {8});
  check_mix("tet10", 2, 6, {8}, true);
  check_mix("tri3", 0, 1, {8}, true);
}

TEST_CASE("all mixes on all numbers of ranks" * doctest::skip()) {
  for (const bool small : {false, true})
    for (const char* element : {"tet4", "tet10", "hex8", "tri3", "quad4"})
      for (std::size_t formulation = 0; formulation < formulations.size(); ++formulation)
        for (std::size_t other = 0; other < others.size(); ++other) {
          if (std::string(element) == "tri3" && formulation % 2 == 1) continue;  // has no mixed formulation
          check_mix(element, formulation, other, {2, 3, 4, 5, 6, 7, 8}, small);
        }
}

TEST_CASE("a mesh of fewer elements than ranks is refused on all of them") {
  json input = bar("hex8", true);
  on_first(std::min(world_size(), 8), [&](MPI_Comm comm) {
    at_work = "three elements";
    alarm(most_seconds);
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    if (ranks > 3) CHECK(solve_on(input, comm).status == "refused");
    alarm(0);
  });
}
