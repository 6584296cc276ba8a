// SPDX-License-Identifier: BSD-3-Clause
// The assembled secant stiffness, and its sparse Cholesky factor.
#include "amg/assembly.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cstddef>
#include <numeric>

#include <kacanov/error.hpp>
#include "parallel/exchange.hpp"
#include "reference/matrix.hpp"

namespace kacanov {

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

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A matrix block as sent between ranks, with global node numbers.
struct SentBlock {
  std::int64_t row = 0, column = 0;
  std::array<double, 9> value{};
};

/// Assembles the free components of every node, in global numbering, with empty rows for held ones.
/// Collective.
Matrix assembled(const Part& part, const NodeGraph& graph, std::span<const double> g,
                 std::span<const NodeBlock> blocks) {
  const std::size_t dim = part.dim();
  const std::vector<double> matrix = assemble_blocks(part.body(), g, graph);
  std::vector<SentBlock> all;
  for (std::size_t n = 0; n < graph.rows(); ++n)
    for (auto k = graph.start[n]; k < graph.start[n + 1]; ++k) {
      const std::size_t m = graph.column[k];
      SentBlock entry{part.node_number(n), part.node_number(m), {}};
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t j = 0; j < dim; ++j)
          if (!part.held[n * dim + i] && !part.held[m * dim + j])
            entry.value[i * dim + j] = matrix[k * dim * dim + i * dim + j];
      all.push_back(entry);
    }
  for (const NodeBlock& block : blocks) {
    SentBlock entry{part.node_number(block.node), part.node_number(block.node), {}};
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j)
        if (!part.held[block.node * dim + i] && !part.held[block.node * dim + j])
          entry.value[i * dim + j] = block.value[i * dim + j];
    all.push_back(entry);
  }
  all = gathered(all, part.node_map);
  const auto size = static_cast<Eigen::Index>(part.total_nodes()) * static_cast<Eigen::Index>(dim);
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(all.size() * dim * dim);
  for (const SentBlock& entry : all)
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j)
        triplets.emplace_back(entry.row * dim + i, entry.column * dim + j, entry.value[i * dim + j]);
  Matrix sum(size, size);
  sum.setFromTriplets(triplets.begin(), triplets.end());
  return sum;
}

}  // namespace

struct Factorised::Factor {
  Eigen::SimplicialLLT<Matrix> factor;
  bool analysed = false;

  void compute(Matrix matrix) {
    const Eigen::VectorXd diagonal = matrix.diagonal();
    const double largest = diagonal.maxCoeff() > 0.0 ? diagonal.maxCoeff() : 1.0;
    if (!analysed) factor.analyzePattern(matrix);
    analysed = true;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      if (diagonal[i] == 0.0) matrix.coeffRef(i, i) = largest;
    // Unconstrained modes get a shift far below any deformation stiffness.
    for (double shift = 1e-14; shift < 1e-3; shift *= 100.0) {
      factor.setShift(shift * largest);
      factor.factorize(matrix);
      if (factor.info() == Eigen::Success) return;
    }
    throw InternalError("the stiffness matrix of the body is not definite");
  }
};

Factorised::Factorised(const Part& part) : part_(&part), graph_(node_graph(part.body().mesh)) {}

Factorised::~Factorised() = default;

void Factorised::build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space&) {
  g_.assign(g.begin(), g.end());
  if (!factor_) factor_ = std::make_unique<Factor>();
  factor_->compute(assembled(*part_, graph_, g_, blocks));
}

void Factorised::secant(std::span<double> g) const { kept_secant(*part_, g_, g); }

void Factorised::apply(std::span<const double> r, std::span<double> z) {
  const std::size_t owned = part_->owned_unknowns(), first = part_->node_map.first() * part_->dim();
  Vector all(part_->total_nodes() * part_->dim(), 0.0);
  std::copy_n(r.begin(), owned, all.begin() + static_cast<std::ptrdiff_t>(first));
  part_->node_map.sum_all(all);
  const Eigen::VectorXd y = factor_->factor.solve(
      Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
  std::copy_n(y.data() + first, owned, z.begin());
  part_->node_map.forward(z, part_->dim());
}

}  // namespace kacanov
