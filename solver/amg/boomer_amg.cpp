// SPDX-License-Identifier: BSD-3-Clause
// hypre's BoomerAMG, and the preconditioner of the assembled body.
#include "amg/boomer_amg.hpp"

#include <array>
#include <limits>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

void check(HYPRE_Int code, const char* what) {
  if (code == 0) return;
  std::array<char, 256> text{};
  HYPRE_DescribeError(code, text.data());
  HYPRE_ClearAllErrors();
  throw InternalError(std::string("hypre: ") + what + " failed: " + text.data());
}

/// hypre keeps global state; the first user initialises it, and it lives as long as MPI.
void start_hypre() {
  static const bool started = [] {
    check(HYPRE_Init(), "HYPRE_Init");
    return true;
  }();
  static_cast<void>(started);
}

HYPRE_ParVector create_vector(MPI_Comm comm, HYPRE_BigInt first, HYPRE_BigInt count, HYPRE_IJVector& vector) {
  check(HYPRE_IJVectorCreate(comm, first, first + count - 1, &vector), "IJVectorCreate");
  check(HYPRE_IJVectorSetObjectType(vector, HYPRE_PARCSR), "IJVectorSetObjectType");
  check(HYPRE_IJVectorInitialize(vector), "IJVectorInitialize");
  check(HYPRE_IJVectorAssemble(vector), "IJVectorAssemble");
  void* object = nullptr;
  check(HYPRE_IJVectorGetObject(vector, &object), "IJVectorGetObject");
  return static_cast<HYPRE_ParVector>(object);
}

}  // namespace

BoomerAmg::BoomerAmg(MPI_Comm comm, std::int64_t first, std::int64_t count, std::int64_t total)
    : comm_(comm), ranks_(mpi_communicator(comm)) {
  ranks_.expect_all_here();
  if (total > std::numeric_limits<HYPRE_BigInt>::max())
    throw InputError("the problem needs a matrix of " + std::to_string(total) +
                     " rows; this hypre is a 32-bit build and takes at most " +
                     std::to_string(std::numeric_limits<HYPRE_BigInt>::max()));
  start_hypre();
  first_ = static_cast<HYPRE_BigInt>(first);
  count_ = static_cast<HYPRE_BigInt>(count);
  right_object_ = create_vector(comm, first_, count_, right_);
  left_object_ = create_vector(comm, first_, count_, left_);
}

BoomerAmg::~BoomerAmg() {
  release();
  HYPRE_IJVectorDestroy(right_);
  HYPRE_IJVectorDestroy(left_);
}

void BoomerAmg::release() {
  if (solver_ != nullptr) HYPRE_BoomerAMGDestroy(solver_);
  if (matrix_ != nullptr) HYPRE_IJMatrixDestroy(matrix_);
  for (const HYPRE_IJVector vector : smooth_) HYPRE_IJVectorDestroy(vector);
  solver_ = nullptr;
  matrix_ = nullptr;
  smooth_.clear();
  smooth_objects_.clear();
}

void BoomerAmg::begin(std::span<const HYPRE_Int> row_sizes) {
  release();
  check(HYPRE_IJMatrixCreate(comm_, first_, first_ + count_ - 1, first_, first_ + count_ - 1, &matrix_),
        "IJMatrixCreate");
  check(HYPRE_IJMatrixSetObjectType(matrix_, HYPRE_PARCSR), "IJMatrixSetObjectType");
  check(HYPRE_IJMatrixSetRowSizes(matrix_, row_sizes.data()), "IJMatrixSetRowSizes");
  check(HYPRE_IJMatrixInitialize(matrix_), "IJMatrixInitialize");
}

void BoomerAmg::add_row(HYPRE_BigInt row, std::span<HYPRE_BigInt> columns, std::span<double> values) {
  auto entries = static_cast<HYPRE_Int>(columns.size());
  check(HYPRE_IJMatrixAddToValues(matrix_, 1, &entries, &row, columns.data(), values.data()),
        "IJMatrixAddToValues");
}

/// hypre does not copy the vectors or their list, so they must live as long as the solver.
void BoomerAmg::reach(std::span<const std::vector<double>> smooth) {
  for (const std::vector<double>& values : smooth) {
    smooth_.push_back(nullptr);
    smooth_objects_.push_back(create_vector(comm_, first_, count_, smooth_.back()));
    check(HYPRE_IJVectorSetValues(smooth_.back(), count_, nullptr, values.data()), "IJVectorSetValues");
  }
  check(HYPRE_BoomerAMGSetInterpVectors(solver_, static_cast<HYPRE_Int>(smooth_objects_.size()),
                                        smooth_objects_.data()),
        "SetInterpVectors");
  // Variant GM1, on every level.
  check(HYPRE_BoomerAMGSetInterpVecVariant(solver_, 1), "SetInterpVecVariant");
  check(HYPRE_BoomerAMGSetInterpVecQMax(solver_, 4), "SetInterpVecQMax");
}

void BoomerAmg::finish(const BoomerAmgOptions& options, std::span<const std::vector<double>> smooth) {
  ranks_.expect_all_here();
  check(HYPRE_IJMatrixAssemble(matrix_), "IJMatrixAssemble");
  void* object = nullptr;
  check(HYPRE_IJMatrixGetObject(matrix_, &object), "IJMatrixGetObject");
  object_ = static_cast<HYPRE_ParCSRMatrix>(object);
  check(HYPRE_BoomerAMGCreate(&solver_), "BoomerAMGCreate");
  check(HYPRE_BoomerAMGSetPrintLevel(solver_, 0), "SetPrintLevel");
  check(HYPRE_BoomerAMGSetMaxIter(solver_, options.cycles), "SetMaxIter");
  check(HYPRE_BoomerAMGSetTol(solver_, 0.0), "SetTol");
  check(HYPRE_BoomerAMGSetNumFunctions(solver_, options.functions), "SetNumFunctions");
  check(HYPRE_BoomerAMGSetCoarsenType(solver_, 10), "SetCoarsenType");  // HMIS
  check(HYPRE_BoomerAMGSetInterpType(solver_, 6), "SetInterpType");     // extended+i
  check(HYPRE_BoomerAMGSetPMaxElmts(solver_, 4), "SetPMaxElmts");
  check(HYPRE_BoomerAMGSetStrongThreshold(solver_, options.strong_threshold), "SetStrongThreshold");
  // l1 Gauss–Seidel forward on the way down, backward on the way up: symmetric at half the cost of symmetric
  // sweeps in both branches (404 CG steps against 385, 4.3 s against 5.1 s of CPU time, 3D beam, h = 1/16);
  // Gaussian elimination on the coarsest level.
  check(HYPRE_BoomerAMGSetCycleRelaxType(solver_, options.both_ways ? 8 : 13, 1), "SetCycleRelaxType");
  check(HYPRE_BoomerAMGSetCycleRelaxType(solver_, options.both_ways ? 8 : 14, 2), "SetCycleRelaxType");
  check(HYPRE_BoomerAMGSetCycleRelaxType(solver_, 9, 3), "SetCycleRelaxType");
  check(HYPRE_BoomerAMGSetAggNumLevels(solver_, options.aggressive_levels), "SetAggNumLevels");
  if (options.nodes_together) {
    check(HYPRE_BoomerAMGSetNodal(solver_, 4), "SetNodal");  // by the row sums of block norms
    check(HYPRE_BoomerAMGSetNodalDiag(solver_, 1), "SetNodalDiag");
  }
  if (!smooth.empty()) reach(smooth);
  check(HYPRE_BoomerAMGSetup(solver_, object_, right_object_, left_object_), "BoomerAMGSetup");
}

void BoomerAmg::apply(const double* r, double* z) {
  ranks_.expect_all_here();
  check(HYPRE_IJVectorSetValues(right_, count_, nullptr, r), "IJVectorSetValues");
  check(HYPRE_ParVectorSetConstantValues(left_object_, 0.0), "ParVectorSetConstantValues");
  check(HYPRE_BoomerAMGSolve(solver_, object_, right_object_, left_object_), "BoomerAMGSolve");
  check(HYPRE_IJVectorGetValues(left_, count_, nullptr, z), "IJVectorGetValues");
}

ElasticityAmg::ElasticityAmg(const Part& part)
    : part_(part),
      amg_(mpi_of(part.node_map), part.node_map.first() * part.dim(),
           static_cast<std::int64_t>(part.owned_unknowns()), part.total_nodes() * part.dim()) {}

void ElasticityAmg::build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space&) {
  g_.assign(g.begin(), g.end());
  const std::size_t dim = part_.dim();
  NodeGraph graph = node_graph(part_.body().mesh);
  std::vector<double> matrix = assemble_blocks(part_.body(), g, graph);
  for (const auto& b : blocks) {
    double* to = &matrix[graph.position(b.node, b.node) * dim * dim];
    for (std::size_t k = 0; k < dim * dim; ++k) to[k] += b.value[k];
  }
  Vector diagonal(part_.unknowns());  // summed over the ranks; kept on held components
  for (std::size_t n = 0; n < graph.rows(); ++n) {
    const double* block =
        &matrix[graph.position(static_cast<std::int32_t>(n), static_cast<std::int32_t>(n)) * dim * dim];
    for (std::size_t i = 0; i < dim; ++i) diagonal[n * dim + i] = block[i * dim + i];
  }
  part_.node_map.sum(diagonal, part_.dim());

  std::vector<HYPRE_Int> sizes(part_.owned_unknowns());
  for (std::size_t i = 0; i < sizes.size(); ++i)
    sizes[i] = static_cast<HYPRE_Int>(dim * graph.row_size(i / dim));
  amg_.begin(sizes);
  std::vector<HYPRE_BigInt> columns;
  std::vector<double> values;
  const auto global = [&](std::size_t node, std::size_t c) {
    return static_cast<HYPRE_BigInt>(part_.node_number(node)) * static_cast<HYPRE_BigInt>(dim) +
           static_cast<HYPRE_BigInt>(c);
  };
  for (std::size_t n = 0; n < graph.rows(); ++n)
    for (std::size_t i = 0; i < dim; ++i) {
      columns.clear();
      values.clear();
      if (part_.held[n * dim + i]) {
        if (n >= static_cast<std::size_t>(part_.owned_nodes())) continue;
        columns.push_back(global(n, i));
        values.push_back(diagonal[n * dim + i]);
      } else {
        for (std::size_t k = graph.start[n]; k < static_cast<std::size_t>(graph.start[n + 1]); ++k)
          for (std::size_t j = 0; j < dim; ++j) {
            const std::size_t m = graph.column[k];
            if (part_.held[m * dim + j]) continue;
            columns.push_back(global(m, j));
            values.push_back(matrix[k * dim * dim + i * dim + j]);
          }
      }
      amg_.add_row(global(n, i), columns, values);
    }
  graph = {};
  std::vector<double>().swap(matrix);
  // One aggressive level in 3D: 1.4 s and 11.7 s against 3.5 s and 15.9 s (setup, solve), 812k unknowns.
  amg_.finish({part_.dim(), part_.dim() == 3 ? 0.5 : 0.25, part_.dim() == 3 ? 1 : 0});
}

void ElasticityAmg::secant(std::span<double> g) const { kept_secant(part_, g_, g); }

void ElasticityAmg::apply(std::span<const double> r, std::span<double> z) {
  amg_.apply(r.data(), z.data());
  part_.node_map.forward(z, part_.dim());
}

}  // namespace kacanov
