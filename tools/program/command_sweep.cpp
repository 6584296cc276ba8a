// SPDX-License-Identifier: BSD-3-Clause
// kacanov sweep: iterations and time over fixed penalties.
#include <cmath>
#include <cstdio>
#include <iostream>

#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include "formats/atomic_file.hpp"
#include "formats/printable.hpp"
#include "mesh/classic_locale_stream.hpp"
#include "pictures/picture.hpp"
#include "program/commands.hpp"
#include "program/loaded_case.hpp"
#include "program/output_folder.hpp"
#include "program/result_json.hpp"

namespace kacanov {
namespace {

/// Reference values in the plot: r* of the elastic body and r_A of the solution.
struct Landmarks {
  double r_star = 0.0, r_active = 0.0;
};

std::vector<double> grid(double low, double high, int points) {
  std::vector<double> values;
  for (int i = 0; i < points; ++i)
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / (points - 1)));
  return values;
}

std::string csv(std::span<const Result> results, std::span<const double> r) {
  PlainText text;
  text.precision(10);
  text << "r,iterations,outer,cg,operator_applications,seconds,status\n";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Result& result = results[i];
    text << r[i] << ',' << result.contact_iterations << ',' << result.outer_iterations << ','
         << result.cg_iterations << ',' << result.operator_applications << ',' << result.seconds.total << ','
         << status_name(result.status) << '\n';
  }
  return text.str();
}

std::string svg(const std::string& title, std::span<const Result> results, std::span<const double> r,
                const Landmarks& landmarks) {
  SweepPicture picture;
  picture.title = title;
  picture.r.assign(r.begin(), r.end());
  for (const Result& result : results) {
    picture.iterations.push_back(static_cast<double>(result.contact_iterations));
    picture.seconds.push_back(result.seconds.total);
    picture.converged.push_back(result.status == Status::converged);
  }
  picture.marks.push_back({"r*", landmarks.r_star});
  if (landmarks.r_active > 0.0) picture.marks.push_back({"r_A", landmarks.r_active});
  return sweep_svg(picture);
}

}  // namespace

int sweep_command(const Command& command, const Case& input, const MpiSession& mpi) {
  together(mpi, [&] {
    if (input.model.contact.empty())
      throw InputError("contact: a sweep over r needs contact, and this case has none");
  });
  LoadedCase loaded = load_case(input, mpi);
  const std::filesystem::path folder = output_folder(command, input);
  std::optional<OutputFolder> held;
  together(mpi, [&] {
    if (mpi.first()) held.emplace(folder);
  });
  RunOptions options;
  options.threads = threads_of(command);
  SolverOptions solver = input.model.solver;
  // A Newton step hardly depends on r: sweep over ADMM unless the case selects another method.
  if (solver.contact == SolverOptions::Contact::automatic) {
    solver.contact = SolverOptions::Contact::admm;
    solver.outer = SolverOptions::Outer::automatic;
  }

  Landmarks landmarks;
  bool any_converged = false;
  std::vector<double> r;
  std::vector<Result> results;
  collectively(mpi, [&] {
    const SpectrumResult elastic = analyse_spectrum(loaded.part, solver, options).back();
    landmarks.r_star = elastic.r_star;
    solver.penalty = SolverOptions::Penalty::automatic;
    solver.r = 0.0;
    const ActivePenalty active =
        active_penalty(loaded.part, solve(loaded.part, solver, options), solver, options);
    landmarks.r_active = active.r;
    if (mpi.first() && !(elastic.converged && active.converged))
      std::cerr << "kacanov: warning: the estimates behind r* and r_A have not all converged: they are rough "
                   "ones (solver.max_cg, solver.spectrum_tolerance)\n";
    const double low = command.r_min.value_or(landmarks.r_star / 10.0);
    const double high = command.r_max.value_or(landmarks.r_star * 100.0);
    if (!(low < high))
      throw InputError("--r-min: must be below --r-max, got " + std::to_string(low) + " and " +
                       std::to_string(high));
    r = grid(low, high, command.points);
    solver.penalty = SolverOptions::Penalty::fixed;
    if (mpi.first()) {
      std::printf("r* = %.4g, r_A = %.4g\n%12s %10s %6s %9s %9s  %s\n", landmarks.r_star, landmarks.r_active,
                  "r", "contact", "outer", "CG", "seconds", "status");
    }
    for (const double value : r) {
      solver.r = value;
      results.push_back(solve(loaded.part, solver, options).result);
      const Result& result = results.back();
      any_converged = any_converged || result.status == Status::converged;
      if (!mpi.first()) continue;
      std::printf("%12.4e %10lld %6d %9lld %9.2f  %s\n", value,
                  static_cast<long long>(result.contact_iterations), result.outer_iterations,
                  static_cast<long long>(result.cg_iterations), result.seconds.total,
                  status_name(result.status));
      std::fflush(stdout);
    }
  });
  together(mpi, [&] {
    if (!mpi.first()) return;
    write_file((folder / "sweep.csv").string(), csv(results, r));
    write_file((folder / "sweep.svg").string(), svg(input.name, results, r, landmarks));
    std::cout << "files: " + printable((folder / "sweep.csv").string()) + ", " +
                     printable((folder / "sweep.svg").string()) + "\n";
  });
  return any_converged ? exit_converged : exit_not_converged;
}

}  // namespace kacanov
