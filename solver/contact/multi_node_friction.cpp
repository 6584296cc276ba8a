// SPDX-License-Identifier: BSD-3-Clause
// Coulomb friction of sliding points at the nodes of multi-node rows (theory: coulomb-newton).
#include "contact/multi_node_friction.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include <kacanov/error.hpp>
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

struct TravellingPair {
  std::int64_t row = 0, node = 0;
  Vector3 held{}, slides{};
};

}  // namespace

/// Factor of R Qᵀ with the rows of R scaled to unit length, slightly shifted.
struct WideSliding::Factor {
  Eigen::VectorXd scale;
  Eigen::SparseMatrix<double> matrix;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> shifted;

  Factor(Eigen::SparseMatrix<double, Eigen::RowMajor> held,
         const Eigen::SparseMatrix<double, Eigen::RowMajor>& slides)
      : scale(held.rows()) {
    for (Eigen::Index i = 0; i < held.rows(); ++i) {
      const double length = held.row(i).norm();
      scale[i] = length > 0.0 ? 1.0 / length : 0.0;
    }
    held = scale.asDiagonal() * held;
    matrix =
        held * Eigen::SparseMatrix<double, Eigen::RowMajor>(held + scale.asDiagonal() * slides).transpose();
    Eigen::SparseMatrix<double> unit(matrix.rows(), matrix.rows());
    unit.setIdentity();
    shifted.compute(matrix + RowCluster::shift * unit);
    if (shifted.info() != Eigen::Success)
      throw InternalError("the rows of wide contact points that slide have no factor");
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    const Eigen::VectorXd right = scale.cwiseProduct(b);
    Eigen::VectorXd z = shifted.solve(right);
    z += shifted.solve(right - matrix * z);
    return scale.cwiseProduct(z);
  }
};

WideSliding::WideSliding(const Part& part, const ActiveSet& set) : part_(&part), nodes_(part) {
  if (!part.wide_contact) return;
  bool slides = false;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    if (!part.contact.is_wide(i) && !nodes_.contains(part.contact[i].node)) continue;
    add_point(set, i);
    slides = slides || (set.held[i].normal && set.coulomb[i] > 0.0);
  }
  if (part.node_map.any(slides)) factorise();
}

WideSliding::~WideSliding() = default;

void WideSliding::add_point(const ActiveSet& set, std::size_t point) {
  const ContactPoint& p = part_->contact[point];
  const double root = std::sqrt(p.mass);
  const auto scaled = [root](const Vector3& v) { return Vector3{root * v[0], root * v[1], root * v[2]}; };
  const int tangents = set.held[point].tangential ? p.tangents : 0;
  std::int64_t number = 3 * static_cast<std::int64_t>(part_->contact_index[point]);
  for (int component = set.held[point].normal ? -1 : 0; component < tangents; ++component) {
    Row row{point, component, point < static_cast<std::size_t>(part_->owned_contact), {}, {}};
    row.held.number = row.slides.number = number++;
    if (row.owned)
      for (const RowEntry& entry : part_->contact.entries(point)) {
        row.held.shares.push_back(
            {entry.node, scaled(component < 0 ? entry.trace : entry.tangent[component])});
        if (component >= 0 || set.coulomb[point] == 0.0) continue;
        Vector3 along{};
        for (std::size_t k = 0; k < static_cast<std::size_t>(p.tangents); ++k)
          for (std::size_t c = 0; c < 3; ++c)
            along[c] += set.coulomb[point] * set.slip_direction[2 * point + k] * entry.tangent[k][c];
        row.slides.shares.push_back({entry.node, scaled(along)});
      }
    rows_.push_back(std::move(row));
  }
}

void WideSliding::factorise() {
  std::vector<TravellingPair> all;
  for (const Row& row : rows_)
    for (std::size_t k = 0; k < row.held.shares.size(); ++k)
      all.push_back({row.held.number, part_->node_number(row.held.shares[k].node),
                     row.held.shares[k].coefficient,
                     row.slides.shares.empty() ? Vector3{} : row.slides.shares[k].coefficient});
  all = gathered(all, part_->node_map);
  std::vector<std::int64_t> nodes;
  for (const TravellingPair& share : all) {
    numbers_.push_back(share.row);
    nodes.push_back(share.node);
  }
  for (auto* list : {&numbers_, &nodes}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  std::vector<Eigen::Triplet<double>> held, slides;
  for (const TravellingPair& share : all) {
    const auto row = static_cast<Eigen::Index>(position(share.row));
    const auto node = 3 * (std::lower_bound(nodes.begin(), nodes.end(), share.node) - nodes.begin());
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Index column = node + static_cast<Eigen::Index>(c);
      if (share.held[c] != 0.0) held.emplace_back(row, column, share.held[c]);
      if (share.slides[c] != 0.0) slides.emplace_back(row, column, share.slides[c]);
    }
  }
  const auto m = static_cast<Eigen::Index>(numbers_.size()), n = static_cast<Eigen::Index>(3 * nodes.size());
  Eigen::SparseMatrix<double, Eigen::RowMajor> r(m, n), s(m, n);
  r.setFromTriplets(held.begin(), held.end());
  s.setFromTriplets(slides.begin(), slides.end());
  factor_ = std::make_unique<Factor>(std::move(r), s);
}

std::size_t WideSliding::position(std::int64_t number) const noexcept {
  return static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), number) -
                                  numbers_.begin());
}

std::vector<double> WideSliding::solve(std::span<const double> force) const {
  std::vector<double> all(numbers_.size(), 0.0);
  for (const Row& row : rows_)
    if (row.owned) all[position(row.held.number)] = row.held.of(force, part_->dim());
  part_->node_map.sum_all(all);  // each entry is nonzero on one rank only
  Eigen::Map<Eigen::VectorXd> values(all.data(), static_cast<Eigen::Index>(all.size()));
  values = factor_->solve(values);
  return all;
}

void WideSliding::subtract(std::span<double> force) const {
  if (!any()) return;
  const std::size_t dim = part_->dim();
  const std::vector<double> x = solve(force);
  std::vector<double> taken = nodes_.zeros(dim);
  for (const Row& row : rows_)
    for (const auto& share : row.slides.shares)
      for (std::size_t c = 0; c < dim; ++c)
        taken[nodes_.position(share.node) * dim + c] -= x[position(row.held.number)] * share.coefficient[c];
  nodes_.add(taken, force);
}

void WideSliding::reactions(std::span<const double> force, ContactValues& lambda) const {
  if (!any()) return;
  const std::vector<double> x = solve(force);
  for (const Row& row : rows_) {
    const double value = x[position(row.held.number)] / std::sqrt(part_->contact[row.point].mass);
    if (row.component < 0)
      lambda.normal[row.point] = value;
    else
      lambda.tangential[2 * row.point + static_cast<std::size_t>(row.component)] = value;
  }
}

}  // namespace kacanov
