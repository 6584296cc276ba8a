// SPDX-License-Identifier: BSD-3-Clause
// Cost of Coulomb friction relative to Tresca friction with the bound of Coulomb's solution at each node.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>
#include <kacanov/solve.hpp>
#include "case/case_file.hpp"
#include "program/loaded_case.hpp"

namespace {

using namespace kacanov;

struct Cost {
  double coulomb = 0.0, tresca = 0.0;  ///< operator applications; 0: not converged
};

double applications(const Solution& solution) {
  return solution.result.status == Status::converged
             ? static_cast<double>(solution.result.operator_applications)
             : 0.0;
}

/// Returns the cost of a case with Coulomb friction, zeros for any other case.
Cost cost_of(const std::string& file) {
  const Case input = parse_case(read_case_text(file), {});
  const Problem problem = build_problem(load_mesh(input.mesh), input.model);
  Part part = distribute(&problem, MPI_COMM_SELF);
  const auto follows = [](const ContactPoint& point) { return point.coulomb > 0.0; };
  if (std::none_of(part.contact.begin(), part.contact.end(), follows)) return {};
  const Solution coulomb = solve(part, input.model.solver, {});
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    part.contact[i].tresca += part.contact[i].coulomb * std::max(coulomb.pressure[i], 0.0);
    part.contact[i].coulomb = 0.0;
  }
  return {applications(coulomb), applications(solve(part, input.model.solver, {}))};
}

void print(const std::vector<std::string>& files) {
  std::vector<double> ratios;
  Cost sum;
  int lost = 0;
  for (const std::string& file : files) {
    const Cost cost = cost_of(file);
    if (cost.coulomb + cost.tresca == 0.0) continue;
    const std::string name = std::filesystem::path(file).stem().string();
    if (cost.coulomb * cost.tresca == 0.0) {
      ++lost;
      std::printf("%s: only %s converges\n", name.c_str(), cost.coulomb > 0.0 ? "Coulomb's" : "Tresca's");
      continue;
    }
    ratios.push_back(cost.coulomb / cost.tresca);
    sum.coulomb += cost.coulomb;
    sum.tresca += cost.tresca;
  }
  if (ratios.empty()) return;
  std::sort(ratios.begin(), ratios.end());
  std::printf("%zu cases: Coulomb %.0f applications, Tresca with the same bounds %.0f: %.2f times as many\n",
              ratios.size(), sum.coulomb, sum.tresca, sum.coulomb / sum.tresca);
  std::printf("ratio of a case: median %.2f, nine in ten within %.2f, largest %.2f; %d left out\n",
              ratios[ratios.size() / 2], ratios[ratios.size() * 9 / 10], ratios.back(), lost);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files;
  CLI::App app("Operator applications of Coulomb friction over those of Tresca's with the same bounds");
  app.add_option("CASE", files, "case files; those without Coulomb friction are passed over")->required();
  CLI11_PARSE(app, argc, argv);
  MPI_Init(nullptr, nullptr);
  print(files);
  MPI_Finalize();
  return 0;
}
