// SPDX-License-Identifier: BSD-3-Clause
// The solve of bench_solve through the C interface: one process with threads, no MPI.
#include <kacanov/kacanov.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "pressed_beam.hpp"

namespace {

using Json = nlohmann::ordered_json;

/// An assembled matrix in compressed rows, for comparison.
struct CsrMatrix {
  std::vector<std::int64_t> first;  ///< rows + 1 entries
  std::vector<std::int32_t> column;
  std::vector<double> value;
};

double threaded_dot(std::span<const double> x, std::span<const double> y, int threads) {
  double sum = 0.0;
#pragma omp parallel for num_threads(threads) reduction(+ : sum)
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

/// Solves A x = b from x = 0 to |r| ≤ relative |b| on OpenMP's threads. Returns the number of iterations.
int solve_by_diagonal(const CsrMatrix& matrix, std::span<const double> b, std::span<double> x,
                      double relative, int threads) {
  const std::size_t n = b.size();
  std::vector<double> r(b.begin(), b.end()), z(n), p(n, 0.0), q(n), scale(n, 1.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = matrix.first[i]; k < matrix.first[i + 1]; ++k)
      if (static_cast<std::size_t>(matrix.column[k]) == i) scale[i] = 1.0 / matrix.value[k];
  const double goal = relative * std::sqrt(threaded_dot(b, b, threads));
  double rz = 1.0;
  int iterations = 0;
  for (; iterations < 20000 && std::sqrt(threaded_dot(r, r, threads)) > goal; ++iterations) {
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) z[i] = scale[i] * r[i];
    const double rz_new = threaded_dot(r, z, threads), beta = iterations == 0 ? 0.0 : rz_new / rz;
    rz = rz_new;
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::int64_t k = matrix.first[i]; k < matrix.first[i + 1]; ++k)
        sum += matrix.value[k] * p[matrix.column[k]];
      q[i] = sum;
    }
    const double alpha = rz / threaded_dot(p, q, threads);
#pragma omp parallel for num_threads(threads)
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
  }
  return iterations;
}

struct Options {
  PressedBeam beam;
  double jump = 1.0, tolerance = 1e-8;
  int threads = 1, repeat = 1;
  std::string preconditioner = "multigrid";  ///< csr: an assembled matrix and its diagonal
  bool json = false;
};

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void check(int code, const char* message) {
  if (code != KACANOV_OK) throw std::runtime_error(message);
}

/// Creates the operator from the part, renumbered for locality, as arrays of a caller.
kacanov_operator* create(const kacanov::Part& part, const Options& options) {
  kacanov_law law{};
  law.struct_size = sizeof law;
  check(kacanov_elastic_law(1.0, options.beam.poisson, &law), "law");
  kacanov_description body{};
  body.struct_size = sizeof body;
  body.element = static_cast<std::int32_t>(part.type);
  body.threads = options.threads;
  body.nodes = part.nodes();
  body.coordinates = part.coordinates.data();
  body.elements = part.element_count();
  body.connectivity = part.elements.data();
  body.laws = 1;
  body.law = &law;
  body.borrow = 1;
  kacanov_operator* op = nullptr;
  char message[256];
  check(kacanov_create(&body, &op, message, sizeof message), message);
  return op;
}

Json entry_of(const Options& options, std::size_t n, const kacanov_cg_result& result) {
  return {{"preconditioner", options.preconditioner + " in C"},
          {"unknowns", n},
          {"threads", options.threads},
          {"element", options.beam.element},
          {"iterations", result.iterations},
          {"converged", result.converged != 0}};
}

/// The same solve with an assembled matrix.
Json measure_csr(kacanov_operator* op, const kacanov::Part& part, const Options& options) {
  const std::size_t n = part.unknowns();
  std::vector<double> b(n, 0.0), x(n, 0.0);
  part.add_load(b);
  for (const auto& held : part.prescribed) b[held.component] = 0.0;
  CsrMatrix matrix;
  const double setup = seconds_of([&] {
    std::size_t entries = 0;
    check(kacanov_matrix_entries(op, n, &entries), kacanov_message(op));
    matrix.first.resize(n + 1);
    matrix.column.resize(entries);
    matrix.value.resize(entries);
    check(kacanov_matrix(op, n, nullptr, entries, matrix.first.data(), matrix.column.data(),
                         matrix.value.data()),
          kacanov_message(op));
  });
  kacanov_cg_result result{};
  result.converged = 1;
  const double solve = seconds_of(
      [&] { result.iterations = solve_by_diagonal(matrix, b, x, options.tolerance, options.threads); });
  Json entry = entry_of(options, n, result);
  entry["setup_seconds"] = setup;
  entry["update_seconds"] = setup;
  entry["solve_seconds"] = solve;
  entry["total_seconds"] = setup + solve;
  entry["bytes_per_unknown"] = 12.0 * static_cast<double>(matrix.value.size()) / static_cast<double>(n);
  return entry;
}

Json measure(kacanov_operator* op, const kacanov::Part& part, const Options& options) {
  const std::size_t n = part.unknowns();
  std::vector<double> b(n, 0.0), x(n, 0.0);
  part.add_load(b);
  for (const auto& held : part.prescribed) b[held.component] = 0.0;
  kacanov_multigrid* multigrid = nullptr;
  const double setup = seconds_of([&] {
    if (options.preconditioner == "multigrid")
      check(kacanov_multigrid_create(op, nullptr, &multigrid), kacanov_message(op));
  });
  kacanov_multigrid_information about{};
  about.struct_size = sizeof about;
  if (multigrid != nullptr) kacanov_multigrid_inspect(multigrid, &about);
  double update = 0.0;
  if (multigrid != nullptr)
    update =
        seconds_of([&] { check(kacanov_multigrid_update(multigrid), kacanov_multigrid_message(multigrid)); });
  kacanov_cg_options cg{};
  cg.struct_size = sizeof cg;
  cg.relative = options.tolerance;
  cg.most_iterations = 20000;
  kacanov_cg_result result{};
  result.struct_size = sizeof result;
  const double solve = seconds_of(
      [&] { check(kacanov_cg(op, multigrid, &cg, n, b.data(), x.data(), &result), kacanov_message(op)); });
  kacanov_multigrid_destroy(multigrid);
  Json entry = entry_of(options, n, result);
  entry["setup_seconds"] = setup;
  entry["update_seconds"] = update;
  entry["solve_seconds"] = solve;
  entry["total_seconds"] = setup + solve;
  entry["bytes_per_unknown"] = static_cast<double>(about.bytes) / static_cast<double>(n);
  return entry;
}

void run(const Options& options) {
  kacanov::Part part;
  kacanov::split(make_pressed_beam(options.beam), 1,
                 [&](int, kacanov::Part&& whole) { part = std::move(whole); });
  kacanov_operator* const op = create(part, options);
  std::vector<std::int32_t> held;
  for (const auto& entry : part.prescribed) held.push_back(entry.component);
  check(kacanov_constrain(op, held.size(), held.data()), kacanov_message(op));
  const std::vector<double> g = varied_secant(part, options.jump);
  check(kacanov_set_secant(op, g.size(), g.data()), kacanov_message(op));
  Json entries = Json::array();
  for (int turn = 0; turn < options.repeat; ++turn) {
    entries.push_back(options.preconditioner == "csr" ? measure_csr(op, part, options)
                                                      : measure(op, part, options));
    const Json& entry = entries.back();
    if (!options.json)
      std::printf(
          "%-15s %9zu unknowns, %d threads: %4d its, setup %.2f s, update %.2f s, solve %.2f s, %.0f "
          "B/unknown\n",
          entry["preconditioner"].get<std::string>().c_str(), part.unknowns(), options.threads,
          entry["iterations"].get<int>(), entry["setup_seconds"].get<double>(),
          entry["update_seconds"].get<double>(), entry["solve_seconds"].get<double>(),
          entry["bytes_per_unknown"].get<double>());
  }
  kacanov_destroy(op);
  if (options.json) std::cout << Json{{"entries", entries}}.dump(2) << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The solve of bench_solve through the C interface");
  app.add_option("--cells", options.beam.cells, "cells across a beam of 4 x 1 x 1");
  app.add_option("--element", options.beam.element)->check([](const std::string& name) {
    return kacanov::element_type(name) ? std::string() : "there is no element " + name;
  });
  app.add_option("--mesh", options.beam.mesh);
  app.add_option("--poisson", options.beam.poisson);
  app.add_option("--aspect", options.beam.aspect);
  app.add_option("--jump", options.jump, "g varies by this factor");
  app.add_option("--tolerance", options.tolerance);
  app.add_option("--threads", options.threads);
  app.add_option("--repeat", options.repeat, "turns");
  app.add_option("--preconditioner", options.preconditioner, "csr: an assembled matrix, and its diagonal")
      ->check(CLI::IsMember({"multigrid", "diagonal", "csr"}));
  app.add_flag("--json", options.json);
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& e) {
    std::cerr << "bench_c_solve: error: " << e.what() << "\n";
    return 2;
  }
  return 0;
}
