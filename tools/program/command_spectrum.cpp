// SPDX-License-Identifier: BSD-3-Clause
// kacanov spectrum: lambda_min, lambda_max and r* of the elastic body.
#include <algorithm>
#include <cstdio>
#include <iostream>

#include <kacanov/error.hpp>
#include <kacanov/solve.hpp>
#include "program/commands.hpp"
#include "program/loaded_case.hpp"
#include "program/report.hpp"
#include "program/result_json.hpp"

namespace kacanov {
namespace {

void print_table(const SpectrumResult& spectrum) {
  std::printf("%s (%lld rows)\n",
              spectrum.friction ? "normal and tangential traces [N; T]" : "normal traces N",
              static_cast<long long>(spectrum.traces));
  std::printf("  lambda_min  %.10g  within %.1e\n", spectrum.lambda_min, spectrum.bound_min);
  std::printf("  lambda_max  %.10g  within %.1e\n", spectrum.lambda_max, spectrum.bound_max);
  std::printf("  r*          %.10g\n", spectrum.r_star);
  std::printf("  cost        %d products, %lld CG iterations, %llu operator applications, %s\n",
              spectrum.products, static_cast<long long>(spectrum.cg_iterations),
              static_cast<unsigned long long>(spectrum.operator_applications),
              readable_seconds(spectrum.seconds).c_str());
  if (!spectrum.converged)
    std::printf(
        "  NOT CONVERGED: a solve took more than solver.max_cg iterations, or Lanczos met its limit\n");
}

}  // namespace

int spectrum_command(const Command& command, const Case& input, const MpiSession& mpi) {
  together(mpi, [&] {
    if (input.model.contact.empty())
      throw InputError("contact: the spectrum is that of the contact nodes, and this case has none");
  });
  const LoadedCase loaded = load_case(input, mpi);
  SolverOptions solver = input.model.solver;
  if (command.tolerance) solver.spectrum_tolerance = *command.tolerance;
  RunOptions options;
  options.threads = threads_of(command);
  std::vector<SpectrumResult> results;
  collectively(mpi, [&] { results = analyse_spectrum(loaded.part, solver, options); });
  const bool converged = std::all_of(results.begin(), results.end(),
                                     [](const SpectrumResult& estimate) { return estimate.converged; });
  const int exit_code = converged ? exit_converged : exit_not_converged;
  if (!mpi.first()) return exit_code;
  if (command.json) {
    const std::int64_t unknowns = loaded.part.total_nodes() * loaded.part.dim();
    std::cout << spectrum_json(results, unknowns, loaded.part.total_contact).dump(2) << std::endl;
    return exit_code;
  }
  for (const SpectrumResult& spectrum : results) print_table(spectrum);
  std::fflush(stdout);
  return exit_code;
}

}  // namespace kacanov
