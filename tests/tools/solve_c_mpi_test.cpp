// SPDX-License-Identifier: BSD-3-Clause
// The C solve interface in a host that has started MPI: on its communicator, and on one of its processes.
#include <doctest/doctest.h>
#include <kacanov/kacanov_solve.h>
#include <mpi.h>

#include <cmath>
#include <cstring>
#include <string>

namespace {

const char* const block =
    R"({"mesh": {"box": {"size": [2, 1, 1], "cells": [6, 3, 3], "element": "tet4"}},
        "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": {"type": "logarithmic", "x0": 0.01}}],
        "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "pressure": 0.01}],
        "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, -0.001], "normal": [0, 0, 1]}}}]})";

struct Run {
  int code = 0;
  std::string message;
  kacanov_solution* solution = nullptr;
  Run(const char* text, const MPI_Comm* comm, kacanov_stop_callback stop = nullptr, void* data = nullptr,
      kacanov_solve_options options = {}) {
    options.struct_size = sizeof options;
    options.communicator = comm;
    options.stop = stop;
    options.data = data;
    char words[256] = "";
    code = kacanov_solve(text, &options, &solution, words, sizeof words);
    message = words;
  }
  ~Run() { kacanov_solution_destroy(solution); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  kacanov_solution_information about() const {
    kacanov_solution_information all{};
    all.struct_size = sizeof all;
    CHECK(kacanov_solution_inspect(solution, &all) == KACANOV_OK);
    return all;
  }
};

}  // namespace

TEST_CASE("all processes of a communicator solve one case, and the first has its arrays") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const MPI_Comm world = MPI_COMM_WORLD;
  const Run together(rank == 0 ? block : "only the first one's text counts", &world), alone(block, nullptr);
  INFO(together.message);
  REQUIRE(together.code == KACANOV_OK);
  REQUIRE(alone.code == KACANOV_OK);
  CHECK(together.about().status == KACANOV_CONVERGED);
  CHECK(std::strstr(kacanov_solution_json(together.solution), "\"converged\"") != nullptr);
  std::size_t count = 0, expected = 0;
  const double* u = kacanov_solution_field(together.solution, KACANOV_FIELD_DISPLACEMENT, &count);
  const double* v = kacanov_solution_field(alone.solution, KACANOV_FIELD_DISPLACEMENT, &expected);
  REQUIRE(count == (rank == 0 ? expected : 0));
  double difference = 0.0, norm = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    difference = std::max(difference, std::abs(u[i] - v[i]));
    norm = std::max(norm, std::abs(v[i]));
  }
  CHECK(difference <= 1e-5 * norm);
  int ended = 0;
  MPI_Finalized(&ended);
  CHECK(ended == 0);
}

TEST_CASE("what is wrong on the first process is said on all, and one process stops all") {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const MPI_Comm world = MPI_COMM_WORLD;
  const Run wrong(rank == 0 ? R"({"mesh": 3, "material": [], "boundary": []})" : block, &world);
  CHECK(wrong.code == KACANOV_ERROR_CASE);
  CHECK(wrong.message.find("mesh: expected an object") != std::string::npos);
  CHECK(wrong.message.find("material: expected at least one") != std::string::npos);
  int last = rank == ranks - 1 ? 1 : 0;
  const Run stopped(
      block, &world, [](void* yes) { return *static_cast<int*>(yes); }, &last);
  REQUIRE(stopped.code == KACANOV_OK);
  CHECK(stopped.about().status == KACANOV_INTERRUPTED);
}

TEST_CASE("options of one process alone: all processes take part in the calls that follow from them") {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const MPI_Comm world = MPI_COMM_WORLD;
  kacanov_solve_options options{};
  options.skip_memory_check = rank == 0 ? 0 : 1;
  int questions = 0;
  const kacanov_stop_callback after_some = [](void* asked) {
    return ++*static_cast<int*>(asked) > 2 ? 1 : 0;
  };
  const Run stopped(block, &world, rank == ranks - 1 ? after_some : nullptr, &questions, options);
  REQUIRE(stopped.code == KACANOV_OK);
  CHECK(stopped.about().status == KACANOV_INTERRUPTED);
  if (ranks == 1) return;
  const Run alone(block, nullptr);
  options.start = rank == 0 ? alone.solution : nullptr;
  const Run some(block, &world, nullptr, nullptr, options);
  CHECK(some.code == KACANOV_ERROR_CASE);
  CHECK(some.message.find("start: expected a solution on all ranks") != std::string::npos);
}

TEST_CASE("a mesh of fewer elements than processes is refused on all") {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const MPI_Comm world = MPI_COMM_WORLD;
  const Run few(R"({"mesh": {"box": {"size": [2, 1, 1], "cells": [1, 1, 1], "element": "hex8"}},
                    "material": [{"on": "all", "young": 1.0, "poisson": 0.3}],
                    "boundary": [{"on": "left", "displacement": [0, 0, 0]}]})",
                &world);
  CHECK(few.code == (ranks == 1 ? KACANOV_OK : KACANOV_ERROR_CASE));
  if (ranks > 1) CHECK(few.message.find("cannot be split into 2 parts") != std::string::npos);
}
