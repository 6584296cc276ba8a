// SPDX-License-Identifier: BSD-3-Clause
// Factory for the preconditioner selected in the options, and the kernels' multigrid as one, with BoomerAMG
// below its aggregates.
#pragma once

#include <memory>
#include <string>

#include <kacanov/model.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/part.hpp>
#include "linear/preconditioner.hpp"
#include "multigrid/multigrid.hpp"

namespace kacanov {

/// Two V-cycles of BoomerAMG on a level over rigid motions (theory: coarse-amg): systems of six unknowns
/// (three in 2D), coarsened row by row, with rotations of the whole body within the interpolation's reach.
/// Throws InputError where hypre cannot number the unknowns. Collective.
std::unique_ptr<CoarseSolver> make_coarse_amg(const CoarseMatrix& matrix);

/// Returns the part in the form that the multigrid needs; the part must outlive it.
inline MultigridBody multigrid_body(const Part& part, const Operator* like = nullptr) {
  return {part.body(), &part.node_map, part.held, like};
}

class PartMultigrid final : public Preconditioner {
 public:
  /// Does not set up yet. The part must outlive it. A setup throws InternalError if the coarsest matrix is
  /// not positive definite.
  PartMultigrid(const Part& part, const MultigridOptions& options, const Operator* like = nullptr)
      : multigrid_(multigrid_body(part, like), options) {}
  void apply(std::span<const double> r, std::span<double> z) override { multigrid_.apply(r, z); }
  void secant(std::span<double> g) const override { multigrid_.secant(g); }
  int kind() const noexcept override { return multigrid_.kind(); }

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override {
    multigrid_.setup(g, blocks, space.held());
  }
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override {
    multigrid_.update(blocks, space.held());
  }

  Multigrid multigrid_;
};

/// `multigrid`: octree or aggregation (theory: multigrid), BoomerAMG below options.coarse_amg rows (theory:
/// coarse-amg); `elasticity`: unknown-based BoomerAMG (theory: elasticity-amg); `cholesky`: a sparse
/// factor of the whole matrix on every rank (theory: factorised). `like`: operator with the
/// part's mesh and laws whose blocks multigrid reuses, or null. The part must outlive it. Collective.
std::unique_ptr<Preconditioner> make_preconditioner(const SolverOptions& options, const Part& part,
                                                    int threads, const std::string& instruction_set,
                                                    const Operator* like = nullptr);

}  // namespace kacanov
