// SPDX-License-Identifier: BSD-3-Clause
// The penalised solve: setup, iterations and memory of the preconditioners, one after the other in one run.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include <kacanov/problem.hpp>
#include "amg/make_preconditioner.hpp"
#include "contact/traces.hpp"
#include "linear/distributed_operator.hpp"
#include "multigrid/cg.hpp"
#include "pressed_beam.hpp"
#include "program/launch.hpp"
#include "program/parallel.hpp"
#include "spectrum/spectrum.hpp"

namespace {

using namespace kacanov;
using Json = nlohmann::ordered_json;

struct Options {
  std::vector<int> cells{40};
  std::string element = "tet4", mesh;
  std::vector<std::string> kinds{"multigrid", "elasticity"};
  std::vector<double> poisson{0.3}, penalty{0.0}, jump{1.0}, aspect{1.0};
  double tolerance = 1e-8;
  int ranks = 0, threads = 1, repeat = 1, coarse_rows = std::numeric_limits<int>::max();
  bool mixed = false, json = false;
};

SolverOptions solver_options(const std::string& kind, const Options& options) {
  SolverOptions solver;
  if (kind == "elasticity") solver.preconditioner = SolverOptions::Preconditioner::elasticity;
  if (kind == "coarse-amg") solver.coarse_amg = options.coarse_rows;
  return solver;
}

PressedBeam beam_of(const Options& options, int cells, double poisson, double aspect) {
  return {.cells = cells,
          .element = options.element,
          .mixed = options.mixed,
          .mesh = options.mesh,
          .poisson = poisson,
          .aspect = aspect};
}

std::int64_t heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
}

std::int64_t status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::int64_t kib = 0;
  while (status >> word)
    if (word == key) status >> kib;
  return kib * 1024;
}

void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

Json measure(const Part& part, DistributedOperator& op, const std::string& kind, const Vector& g,
             double penalty, const Options& options) {
  const Space space(part);
  const TraceRows rows(part, std::vector<TraceChoice>(part.contact.size(), {true, false}));
  const auto blocks = penalty > 0.0 ? rows.penalty_blocks(penalty) : std::vector<NodeBlock>{};
  malloc_trim(0);
  reset_peak();
  const std::int64_t heap = heap_bytes(), resident = status_bytes("VmRSS:");
  MPI_Barrier(mpi_of(part.node_map));
  const double begin = MPI_Wtime();
  const auto amg = make_preconditioner(solver_options(kind, options), part, options.threads, "");
  MPI_Barrier(mpi_of(part.node_map));
  const double start = MPI_Wtime();
  amg->setup(g, blocks, space);
  const double ready = MPI_Wtime();
  const std::int64_t held = part.node_map.sum_all(heap_bytes() - heap);
  const std::int64_t peak = part.node_map.sum_all(status_bytes("VmHWM:") - resident);
  CgWork work;
  work.resize(part.unknowns());
  Vector x(part.unknowns(), 0.0);
  part.add_load(work.residual);
  const Traces traces(part);
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    const double share = op.apply(p, q);
    return share + traces.add_penalty({penalty, 0.0}, p, q);
  };
  const auto precondition = [&](std::span<const double> r, std::span<double> z) { amg->apply(r, z); };
  const double before = MPI_Wtime();
  const CgResult cg =
      conjugate_gradients(space, apply, precondition, x, work, {0.0, options.tolerance, 2000});
  const double seconds = MPI_Wtime() - before;
  return {
      {"preconditioner", kind},
      {"unknowns", part.total_nodes() * part.dim()},
      {"ranks", part.node_map.ranks},
      {"threads", options.threads},
      {"iterations", cg.iterations},
      {"converged", cg.converged},
      {"make_seconds", start - begin},  // once per run: the operator in single precision
      {"setup_seconds", ready - start},
      {"solve_seconds", seconds},
      {"total_seconds", ready - start + seconds},
      {"seconds_per_iteration", seconds / std::max(1, cg.iterations)},
      {"bytes_per_unknown", static_cast<double>(held) / static_cast<double>(part.total_nodes() * part.dim())},
      {"peak_bytes_per_unknown",
       static_cast<double>(peak) / static_cast<double>(part.total_nodes() * part.dim())}};
}

void run(const Options& options, const MpiSession& mpi) {
  Json entries = Json::array();
  if (mpi.first() && !options.json)
    std::printf("%-12s %9s %6s %8s %7s %7s | %5s %8s %8s %8s %9s %9s\n", "", "unknowns", "nu", "r", "g jump",
                "aspect", "its", "setup s", "solve s", "total s", "B/unknown", "peak B/u");
  for (const int cells : options.cells)
    for (const double poisson : options.poisson)
      for (const double aspect : options.aspect) {
        Part part;
        {
          std::optional<Problem> problem;
          if (mpi.first()) problem = make_pressed_beam(beam_of(options, cells, poisson, aspect));
          part = distribute(problem ? &*problem : nullptr, mpi.comm());
        }
        DistributedOperator op(part, options.threads, "");
        for (const double jump : options.jump) {
          const Vector g = varied_secant(part, jump);
          op.set_secant(g);
          for (const double penalty : options.penalty)
            for (int turn = 0; turn < options.repeat; ++turn)
              for (const std::string& kind : options.kinds) {
                Json entry = measure(part, op, kind, g, penalty, options);
                entry["element"] = options.mesh.empty() ? options.element : options.mesh;
                entry["mixed"] = options.mixed;
                entry["poisson"] = poisson;
                entry["penalty"] = penalty;
                entry["jump"] = jump;
                entry["aspect"] = aspect;
                if (mpi.first() && !options.json) {
                  std::printf("%-12s %9lld %6.3g %8.3g %7.3g %7.3g | %5d%s %7.2f %8.2f %8.2f %9.0f %9.0f\n",
                              kind.c_str(), entry["unknowns"].get<long long>(), poisson, penalty, jump,
                              aspect, entry["iterations"].get<int>(),
                              entry["converged"].get<bool>() ? " " : "!",
                              entry["setup_seconds"].get<double>(), entry["solve_seconds"].get<double>(),
                              entry["total_seconds"].get<double>(), entry["bytes_per_unknown"].get<double>(),
                              entry["peak_bytes_per_unknown"].get<double>());
                  std::fflush(stdout);
                }
                entries.push_back(std::move(entry));
              }
        }
      }
  if (mpi.first() && options.json) std::cout << Json{{"entries", entries}}.dump(2) << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The penalised solve by preconditioner: seconds, iterations, bytes");
  app.add_option("--cells", options.cells,
                 "cells across a beam of 4 x 1 x 1 (40: 811,923 unknowns with tet4)");
  app.add_option("--element", options.element)->check([](const std::string& name) {
    return element_type(name) ? std::string() : "there is no element " + name;
  });
  app.add_option("--mesh", options.mesh,
                 "a Gmsh file instead of the beam; held at its lowest x, pressed from above");
  app.add_option("--preconditioner", options.kinds)
      ->check(CLI::IsMember({"multigrid", "coarse-amg", "elasticity"}));
  app.add_option("--coarse-rows", options.coarse_rows, "coarse-amg: largest level that goes to BoomerAMG");
  app.add_option("--poisson", options.poisson);
  app.add_option("--penalty", options.penalty, "r on the whole bottom");
  app.add_option("--jump", options.jump, "g varies by this factor");
  app.add_option("--aspect", options.aspect, "length of a cell over its width");
  app.add_option("--tolerance", options.tolerance);
  app.add_option("--ranks", options.ranks, "0: one a core");
  app.add_option("--threads", options.threads);
  app.add_option("--repeat", options.repeat, "turns");
  app.add_flag("--mixed", options.mixed, "the mixed formulation of the element");
  app.add_flag("--json", options.json);
  CLI11_PARSE(app, argc, argv);
  if (!started_by_mpi()) {
    const int ranks = options.ranks > 0 ? options.ranks : usable_cores();
    if (ranks > 1)
      return run_under_mpiexec(find_mpiexec(), {ranks, options.threads},
                               {{argv, static_cast<std::size_t>(argc)}, "", std::filesystem::current_path()});
    set_mpi_environment();
  }
  const MpiSession mpi;
  try {
    run(options, mpi);
  } catch (const std::exception& e) {
    std::cerr << "bench_solve: error: " << e.what() << "\n";
    if (mpi.ranks() > 1) MPI_Abort(mpi.comm(), 2);
    return 2;
  }
  return coded_exit(0);
}
