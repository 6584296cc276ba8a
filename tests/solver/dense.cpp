// SPDX-License-Identifier: BSD-3-Clause
// Dense stiffness, traces and spectrum of small parts.
#include "dense.hpp"

#include <cmath>

#include <kacanov/reference.hpp>

#include "../dense_algebra.hpp"

namespace kacanov::testing {

Eigen::MatrixXd dense_stiffness(const Part& part, std::span<const double> g) {
  const std::size_t dim = part.dim();
  const std::size_t npe = nodes_per_element(part.type);
  const std::size_t rows = npe * dim, points = g.size() / part.element_count();
  const auto n = static_cast<Eigen::Index>(part.unknowns());
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, n);
  std::vector<double> element(rows * rows);
  const auto unknown = [&](std::size_t e, std::size_t i) {
    return static_cast<Eigen::Index>(static_cast<std::size_t>(part.elements[e * npe + i / dim]) * dim +
                                     i % dim);
  };
  for (std::size_t e = 0; e < part.element_count(); ++e) {
    reference::element_matrix(part.body(), e, g.subspan(e * points, points), element);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < rows; ++j) b(unknown(e, i), unknown(e, j)) += element[i * rows + j];
  }
  return b;
}

Eigen::MatrixXd dense_traces(const Part& part, bool friction) {
  const std::size_t dim = part.dim();
  std::vector<Eigen::VectorXd> rows;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    const auto add = [&](const auto& coefficients) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(part.unknowns()));
      for (const RowEntry& entry : part.contact.entries(i))
        for (std::size_t c = 0; c < dim; ++c)
          row(static_cast<Eigen::Index>(static_cast<std::size_t>(entry.node) * dim + c)) =
              std::sqrt(part.contact[i].mass) * coefficients(entry)[c];
      rows.push_back(row);
    };
    add([](const RowEntry& entry) { return entry.trace; });
    for (std::size_t k = 0; friction && k < static_cast<std::size_t>(part.contact[i].tangents); ++k)
      add([k](const RowEntry& entry) { return entry.tangent[k]; });
  }
  Eigen::MatrixXd c(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(part.unknowns()));
  for (std::size_t i = 0; i < rows.size(); ++i) c.row(static_cast<Eigen::Index>(i)) = rows[i];
  return c;
}

std::vector<int> free_components(const Part& part) {
  std::vector<int> free;
  for (std::size_t i = 0; i < part.unknowns(); ++i)
    if (!part.held[i]) free.push_back(static_cast<int>(i));
  return free;
}

Eigen::VectorXd dense_spectrum(const Part& part, bool friction) {
  std::vector<double> g(part.body().secant_count());
  const std::vector<double> zero(part.unknowns(), 0.0);
  reference::secant(part.body(), zero, g);
  const auto free = free_components(part);
  const Eigen::MatrixXd b = dense_stiffness(part, g)(free, free);
  const Eigen::MatrixXd c = dense_traces(part, friction)(Eigen::all, free);
  const Eigen::VectorXd all = symmetric_eigenvalues(schur_complement(b, c));
  Eigen::Index zeros = 0;
  while (zeros < all.size() && all(zeros) < 1e-10 * all(all.size() - 1)) ++zeros;
  return all.tail(all.size() - zeros);
}

}  // namespace kacanov::testing
