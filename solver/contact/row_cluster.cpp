// SPDX-License-Identifier: BSD-3-Clause
// Rows that share nodes: their joint pseudo-inverse, and the projection that holds them.
#include "contact/row_cluster.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include <kacanov/error.hpp>
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A row's share as sent between ranks.
struct Travelling {
  std::int64_t row = 0, node = 0;
  Vector3 coefficient{};
};

}  // namespace

/// Factor of C Cᵀ with the rows scaled to unit length, slightly shifted.
struct RowCluster::Factor {
  Eigen::VectorXd scale;  ///< 1 / length of each row
  Eigen::SparseMatrix<double> gram;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> shifted;

  explicit Factor(Rows rows) : scale(rows.rows()) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const double length = rows.row(i).norm();
      scale[i] = length > 0.0 ? 1.0 / length : 0.0;
    }
    rows = scale.asDiagonal() * rows;
    gram = rows * rows.transpose();
    Eigen::SparseMatrix<double> unit(gram.rows(), gram.rows());
    unit.setIdentity();
    shifted.compute(gram + shift * unit);
    if (shifted.info() != Eigen::Success)
      throw InternalError("the rows of wide contact points have no factor");
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    const Eigen::VectorXd right = scale.cwiseProduct(b);
    Eigen::VectorXd z = shifted.solve(right);
    z += shifted.solve(right - gram * z);
    return scale.cwiseProduct(z);
  }
};

RowCluster::RowCluster(const Part& part, const WideNodes& nodes, std::vector<ClusterRow> rows)
    : part_(&part), nodes_(nodes), rows_(std::move(rows)) {
  std::vector<Travelling> all;
  for (const ClusterRow& row : rows_)
    for (const auto& share : row.shares)
      all.push_back({row.number, part.node_number(share.node), share.coefficient});
  all = gathered(all, part.node_map);
  std::vector<std::int64_t> node_numbers;
  for (const Travelling& share : all) {
    numbers_.push_back(share.row);
    node_numbers.push_back(share.node);
  }
  for (auto* list : {&numbers_, &node_numbers}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  const auto m = static_cast<Eigen::Index>(numbers_.size());
  const auto n = static_cast<Eigen::Index>(3 * node_numbers.size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (const Travelling& share : all) {
    const auto row = static_cast<Eigen::Index>(position(share.row));
    const auto node = std::lower_bound(node_numbers.begin(), node_numbers.end(), share.node);
    for (std::size_t c = 0; c < 3; ++c)
      if (share.coefficient[c] != 0.0)
        triplets.emplace_back(row, 3 * (node - node_numbers.begin()) + static_cast<Eigen::Index>(c),
                              share.coefficient[c]);
  }
  Rows c(m, n);
  c.setFromTriplets(triplets.begin(), triplets.end());
  factor_ = std::make_unique<Factor>(std::move(c));
}

RowCluster::~RowCluster() = default;

std::size_t RowCluster::position(std::int64_t number) const noexcept {
  return static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), number) -
                                  numbers_.begin());
}

void RowCluster::solve_gathered(Vector& b) const {
  part_->node_map.sum_all(b);  // each entry is nonzero on one rank only
  Eigen::Map<Eigen::VectorXd> values(b.data(), static_cast<Eigen::Index>(b.size()));
  values = factor_->solve(values);
}

void RowCluster::add_transpose(std::span<const double> z, std::span<double> y) const {
  const std::size_t dim = part_->dim();
  Vector forces = nodes_.zeros(dim);
  for (const ClusterRow& row : rows_) {
    const double value = z[position(row.number)];
    for (const auto& share : row.shares)
      for (std::size_t c = 0; c < dim; ++c)
        forces[nodes_.position(share.node) * dim + c] += value * share.coefficient[c];
  }
  nodes_.add(forces, y);
}

void RowCluster::project(std::span<double> x) const {
  const std::size_t dim = part_->dim();
  Vector z = solve([&](const ClusterRow& row) { return row.of(x, dim); });
  for (double& value : z) value = -value;
  add_transpose(z, x);
}

}  // namespace kacanov
