// SPDX-License-Identifier: BSD-3-Clause
// hypre's BoomerAMG on the assembled body, and on a coarse level of the multigrid.
#include "amg/boomer_amg.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/mpi_communicator.hpp>
#include "multigrid/rigid_motion.hpp"
#include "reference/element_stiffness.hpp"

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

std::size_t NodeGraph::position(std::int32_t row, std::int32_t column_node) const {
  const auto first = column.begin() + start[row];
  const auto last = column.begin() + start[static_cast<std::size_t>(row) + 1];
  return static_cast<std::size_t>(std::lower_bound(first, last, column_node) - column.begin());
}

NodeGraph node_graph(const MeshView& mesh) {
  const std::size_t npe = nodes_per_element(mesh.type);
  const std::size_t nodes = mesh.node_count(), elements = mesh.element_count();

  std::vector<std::int64_t> first(nodes + 1, 0);
  for (const std::int32_t n : mesh.connectivity) ++first[static_cast<std::size_t>(n) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::int32_t> element_of(mesh.connectivity.size());
  auto at = first;
  for (std::size_t e = 0; e < elements; ++e)
    for (std::size_t a = 0; a < npe; ++a)
      element_of[at[mesh.connectivity[e * npe + a]]++] = static_cast<std::int32_t>(e);

  NodeGraph graph;
  graph.start.reserve(nodes + 1);
  graph.start.push_back(0);
  std::vector<std::int32_t> row;
  for (std::size_t n = 0; n < nodes; ++n) {
    row.assign(1, static_cast<std::int32_t>(n));
    for (auto k = first[n]; k < first[n + 1]; ++k) {
      const std::size_t e = element_of[k];
      const auto element = mesh.connectivity.subspan(e * npe, npe);
      row.insert(row.end(), element.begin(), element.end());
    }
    std::sort(row.begin(), row.end());
    graph.column.insert(graph.column.end(), row.begin(), std::unique(row.begin(), row.end()));
    graph.start.push_back(static_cast<std::int64_t>(graph.column.size()));
  }
  return graph;
}

std::vector<double> assemble_blocks(const Body& body, std::span<const double> g, const NodeGraph& graph) {
  const auto& mesh = body.mesh;
  const std::size_t npe = nodes_per_element(mesh.type);
  const std::size_t points = points_per_element(mesh.type);
  const std::size_t dim = dimension(mesh.type);
  const std::size_t width = npe * dim;
  std::vector<double> value(graph.column.size() * dim * dim, 0.0), local(width * width);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    element_stiffness(body, e, g.subspan(e * points, points), local);
    const auto element = mesh.connectivity.subspan(e * npe, npe);
    for (std::size_t a = 0; a < npe; ++a)
      for (std::size_t b = 0; b < npe; ++b) {
        double* to = &value[graph.position(element[a], element[b]) * dim * dim];
        for (std::size_t i = 0; i < dim; ++i)
          for (std::size_t j = 0; j < dim; ++j) to[i * dim + j] += local[(a * dim + i) * width + b * dim + j];
      }
  }
  return value;
}

void kept_secant(const Part& part, std::span<const double> kept, std::span<double> g) {
  const Body body = part.body();
  if (kept.empty())
    for (std::size_t i = 0; i < g.size(); ++i) g[i] = body.law(i / (g.size() / part.element_count())).shear;
  else
    std::copy(kept.begin(), kept.end(), g.begin());
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

namespace {

/// Returns the owned rows of the rotations of the whole body about its centre. Collective.
template <int M>
std::vector<std::vector<double>> rotations(const CoarseMatrix& matrix) {
  std::array<double, 4> sum{};
  for (const Vector3& c : matrix.centres) sum[0] += c[0], sum[1] += c[1], sum[2] += c[2], sum[3] += 1.0;
  matrix.map->sum_all(std::span<double>(sum));
  std::vector<std::vector<double>> all;
  for (int turn = RigidMotion<M>::dim; turn < M; ++turn) {
    std::array<double, M> motion{};
    motion[static_cast<std::size_t>(turn)] = 1.0;
    std::vector<double> rows(matrix.centres.size() * M, 0.0);
    for (std::size_t i = 0; i < matrix.centres.size(); ++i) {
      const Vector3& c = matrix.centres[i];
      const Vector3 d{c[0] - sum[0] / sum[3], c[1] - sum[1] / sum[3], c[2] - sum[2] / sum[3]};
      RigidMotion<M>::add_to_part(motion.data(), d.data(), 1.0 / matrix.length, &rows[i * M]);
    }
    all.push_back(std::move(rows));
  }
  return all;
}

/// Returns the largest diagonal entry over all ranks.
double largest_diagonal(const CoarseMatrix& matrix) {
  const std::size_t motions = matrix.motions;
  double largest = 0.0;
  for (std::size_t k = 0; k < matrix.row.size(); ++k)
    for (std::size_t m = 0; m < motions && matrix.row[k] == matrix.column[k]; ++m)
      largest = std::max(largest, matrix.block[(k * motions + m) * motions + m]);
  return matrix.map->max_all(largest);
}

class CoarseAmg final : public CoarseSolver {
 public:
  explicit CoarseAmg(const CoarseMatrix& matrix);
  void solve(std::span<const double> b, std::span<double> x) override { amg_.apply(b.data(), x.data()); }

 private:
  BoomerAmg amg_;
};

CoarseAmg::CoarseAmg(const CoarseMatrix& matrix)
    : amg_(mpi_of(*matrix.map), matrix.map->first() * matrix.motions,
           static_cast<std::int64_t>(matrix.centres.size()) * matrix.motions,
           matrix.map->total() * matrix.motions) {
  const std::size_t motions = matrix.motions;
  const std::int64_t first = matrix.map->first();
  std::vector<HYPRE_Int> sizes(matrix.centres.size() * motions, 0);
  for (const std::int64_t row : matrix.row)
    for (std::size_t m = 0; m < motions; ++m)
      sizes[static_cast<std::size_t>(row - first) * motions + m] += matrix.motions;
  amg_.begin(sizes);
  std::vector<HYPRE_BigInt> columns(motions);
  std::vector<double> values(motions);
  const auto global = [&](std::int64_t row, std::size_t motion) {
    return static_cast<HYPRE_BigInt>(row * matrix.motions + static_cast<std::int64_t>(motion));
  };
  // A shift far below all stiffnesses, against rounding and modes that boundary conditions have removed.
  const double largest = largest_diagonal(matrix), shift = largest > 0.0 ? 1e-10 * largest : 1.0;
  for (std::size_t k = 0; k < matrix.row.size(); ++k)
    for (std::size_t m = 0; m < motions; ++m) {
      for (std::size_t n = 0; n < motions; ++n) {
        columns[n] = global(matrix.column[k], n);
        values[n] = matrix.block[(k * motions + m) * motions + n];
      }
      if (matrix.row[k] == matrix.column[k]) values[m] += shift;
      amg_.add_row(global(matrix.row[k], m), columns, values);
    }
  // Measured for tet4, g varying by a factor of 100, 107,163 unknowns: 229 iterations unknown-based without
  // rotations, 166 nodal with rotations, 153 with strong threshold 0.25 instead of 0.5, 140 with symmetric
  // sweeps, 112 with two cycles; 90 with this project's own levels (experiments: coarse-amg).
  const BoomerAmgOptions options{.functions = matrix.motions,
                                 .strong_threshold = 0.25,
                                 .nodes_together = true,
                                 .both_ways = true,
                                 .cycles = 2};
  amg_.finish(options, matrix.motions == 6 ? rotations<6>(matrix) : rotations<3>(matrix));
}

}  // namespace

std::unique_ptr<CoarseSolver> make_coarse_amg(const CoarseMatrix& matrix) {
  return std::make_unique<CoarseAmg>(matrix);
}

}  // namespace kacanov
