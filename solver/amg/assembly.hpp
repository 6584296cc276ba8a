// SPDX-License-Identifier: BSD-3-Clause
// The assembled secant stiffness, and its sparse Cholesky factor, for small bodies on which multigrid fails.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/reference.hpp>
#include "linear/preconditioner.hpp"

namespace kacanov {

/// Which local nodes share an element: compressed rows, columns ascending, the diagonal included.
struct NodeGraph {
  std::vector<std::int64_t> start;  ///< nodes + 1
  std::vector<std::int32_t> column;

  std::size_t rows() const noexcept { return start.size() - 1; }
  /// Entries of a row.
  std::size_t row_size(std::size_t row) const noexcept {
    return static_cast<std::size_t>(start[row + 1] - start[row]);
  }
  /// Where (row, column) stands; it must be in the graph.
  std::size_t position(std::int32_t row, std::int32_t column_node) const;
};

/// The graph of a rank's elements. Not collective.
NodeGraph node_graph(const MeshView& mesh);

/// Sum of the element matrices for frozen g (elements × points, a stress): one dim × dim block (row-major) an
/// entry of the graph, which is node_graph() of this body. Rows of shared nodes hold this rank's
/// contributions only. Not collective.
std::vector<double> assemble_blocks(const Body& body, std::span<const double> g, const NodeGraph& graph);

/// g = `kept`, what a preconditioner was set up with; mu where that is none.
void kept_secant(const Part& part, std::span<const double> kept, std::span<double> g);

/// (B(g) + blocks)⁻¹ in double precision (theory: factorised), with the same factor on every rank. Directions
/// held by the space are represented by the blocks only.
class Factorised final : public Preconditioner {
 public:
  /// Does not set up yet. The part must outlive it. A setup throws InternalError if the matrix is not
  /// positive definite. Not collective.
  explicit Factorised(const Part& part);
  ~Factorised() override;
  void apply(std::span<const double> r, std::span<double> z) override;
  void secant(std::span<double> g) const override;

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override;
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override {
    build(std::vector<double>(g_), blocks, space);
  }

  struct Factor;
  const Part* part_;
  NodeGraph graph_;
  std::vector<double> g_;
  std::unique_ptr<Factor> factor_;
};

}  // namespace kacanov
