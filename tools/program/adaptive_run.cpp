// SPDX-License-Identifier: BSD-3-Clause
// Adaptive mesh refinement of a case, driven by its error estimate.
#include "program/adaptive_run.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <kacanov/discretisation.hpp>
#include <kacanov/error.hpp>
#include <kacanov/refine.hpp>
#include <kacanov/solve.hpp>
#include "program/loaded_case.hpp"
#include "program/obstacle_files.hpp"
#include "program/report.hpp"
#include "program/solve_case.hpp"

namespace kacanov {
namespace {

/// Fraction of the squared error in the elements to refine; less if that reaches the target: halving an
/// element leaves a fraction 4⁻ᵖ of its squared error.
constexpr double most_refined = 0.5, least_refined = 0.1;

/// Tolerated penetration between nodes, as a fraction of the largest displacement. Corners of quadratic
/// facets carry no contact force and penetrate slightly on any mesh.
constexpr double entered_at_most = 0.05;

double share_to_refine(double error, double aim, int order) {
  const double to_lose = 1.0 - aim * aim / (error * error);
  return std::clamp(to_lose / (1.0 - std::ldexp(1.0, -2 * order)), least_refined, most_refined);
}

class Adaptation {
 public:
  Adaptation(Case& input, const MpiSession& mpi, const RunOptions& options)
      : input_(input), mpi_(mpi), options_(options), aim_(*input.mesh.adapt) {}

  CoarseRun run() {
    for (int number = 1; !stop_wanted(mpi_, options_); ++number) {
      if (mpi_.first() && options_.phase)
        options_.phase("solving on mesh " + std::to_string(number) + " to refine it");
      const std::vector<double> error = solve_on_it();
      const CoarseLevel& level = run_.levels.back();
      if (mpi_.first() && !mpi_.hosted() && options_.progress) std::cout << level_line(level) << std::flush;
      if (level.converged && level.error == 0.0 && !enters())
        input_.warnings.push_back(
            "mesh.adapt: nothing strains the body on this mesh, so that nothing says where to refine it");
      if (!level.converged || (level.error <= aim_.error && !enters())) break;
      if (number == aim_.most_meshes) {
        limit_met("mesh.adapt.most_meshes = " + std::to_string(number));
        break;
      }
      if (!refine(error)) {
        limit_met("mesh.adapt.most_unknowns = " + std::to_string(aim_.most_unknowns));
        break;
      }
    }
    if (any_moves(input_.model)) run_.solutions.clear();
    return std::move(run_);
  }

 private:
  /// Solves on the current mesh; returns the error energy of each element.
  std::vector<double> solve_on_it() {
    const double began = MPI_Wtime();
    std::optional<Problem> problem;
    together(mpi_, [&] {
      if (!mpi_.first()) return;
      if (!input_.mesh.adapted) {
        input_.mesh.adapted = std::make_shared<const Mesh>(load_mesh(input_.mesh));
        refuse_to_bisect(input_.mesh.adapted->type);
      }
      problem = load_problem(input_, {mpi_.ranks(), 0});
    });
    Part part = distribute(problem ? &*problem : nullptr, mpi_.comm());
    const Problem* whole = problem ? &*problem : nullptr;
    std::vector<CoarseSolution> before;
    // With moving obstacles, every mesh follows the whole path by itself.
    const Solution solution =
        any_moves(input_.model)
            ? solve_part(input_, part, mpi_, silent(options_))
            : solve_roughly(input_, part, silent(options_), run_, [&](const Part& now, const Solution& step) {
                before.push_back(whole_solution(now, whole, step));
              });
    DiscretisationError error = estimate_error(part, solution);
    run_.take(solution, std::move(before), part, whole, began);
    run_.levels.back().error = error.relative;
    if (solution.result.status == Status::converged)
      find_penetrated(whole, gather_nodal(part, solution.displacement, part.dim()));
    std::vector<double> all(static_cast<std::size_t>(part.total_elements), 0.0);
    for (std::size_t e = 0; e < error.element.size(); ++e) all[part.element_index[e]] = error.element[e];
    part.node_map.sum_all(all);
    return all;
  }

  /// Finds elements that penetrate an obstacle. `u`: on the whole mesh; on the first rank, as the problem.
  void find_penetrated(const Problem* problem, const std::vector<double>& u) {
    together(mpi_, [&] {
      if (problem == nullptr) return;
      double largest = 0.0;
      for (const double component : u) largest = std::max(largest, std::abs(component));
      entered_ = penetrated_elements(*problem, model_with_files(input_), u, entered_at_most * largest);
    });
    entered_count_ = static_cast<std::int64_t>(entered_.size());
    mpi_.expect_all_here();
    MPI_Bcast(&entered_count_, 1, MPI_INT64_T, 0, mpi_.comm());
  }

  /// Returns whether the body penetrates an obstacle between its nodes, which a mesh too coarse there allows.
  bool enters() const { return entered_count_ > 0; }

  /// Refines the mesh; returns whether the new one is within the limit.
  bool refine(const std::vector<double>& error) {
    int fits = 0;
    together(mpi_, [&] {
      if (!mpi_.first()) return;
      const Mesh& mesh = *input_.mesh.adapted;
      const double share = share_to_refine(run_.levels.back().error, aim_.error, cell(mesh.type).order);
      std::vector<std::int32_t> marked = worst_elements(error, share);
      marked.insert(marked.end(), entered_.begin(), entered_.end());
      Mesh finer = bisect(mesh, marked);
      const auto unknowns = static_cast<std::int64_t>(finer.coordinates.size());
      fits = unknowns <= aim_.most_unknowns ? 1 : 0;
      if (fits == 0) return;
      finer.warnings = mesh.warnings;
      input_.mesh.adapted = std::make_shared<const Mesh>(std::move(finer));
    });
    mpi_.expect_all_here();
    MPI_Bcast(&fits, 1, MPI_INT, 0, mpi_.comm());
    return fits == 1;
  }

  void limit_met(const std::string& limit) {
    const std::string entered = enters() ? ", and goes through an obstacle between the nodes of " +
                                               std::to_string(entered_count_) + " elements"
                                         : "";
    input_.warnings.push_back(limit + ": the mesh is refined no further, with an estimated error of " +
                              readable_share(run_.levels.back().error) + " in place of " +
                              readable_share(aim_.error) + entered);
  }

  Case& input_;
  const MpiSession& mpi_;
  const RunOptions& options_;
  const Adaptivity aim_;
  CoarseRun run_;
  std::vector<std::int32_t> entered_;  ///< elements, on the first rank
  std::int64_t entered_count_ = 0;     ///< on all ranks
};

}  // namespace

CoarseRun adapt(Case& input, const MpiSession& mpi, const RunOptions& options) {
  return Adaptation(input, mpi, options).run();
}

}  // namespace kacanov
