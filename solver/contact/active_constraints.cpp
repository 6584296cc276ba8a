// SPDX-License-Identifier: BSD-3-Clause
// Active constraints at the contact nodes: gap closing, and contact reactions from nodal forces.
#include "contact/active_constraints.hpp"

#include <algorithm>
#include <cmath>

#include "problem/dense.hpp"

namespace kacanov {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A direction with a smaller component orthogonal to those already held depends on them.
constexpr double dependent = 1e-8;

Eigen::Vector3d to_eigen(const Vector3& v) { return {v[0], v[1], v[2]}; }
Vector3 from_eigen(const Eigen::Vector3d& v) { return {v(0), v(1), v(2)}; }

}  // namespace

HeldNodes::HeldNodes(const Part& part, const ActiveSet& set, const ContactState& state)
    : part_(&part), wide_(part, set) {
  const auto points = part.contact.points();
  const WideNodes wide(part);
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i + 1;
    while (end < points.size() && points[end].node == points[i].node) ++end;
    const bool held = std::any_of(set.held.begin() + static_cast<std::ptrdiff_t>(i),
                                  set.held.begin() + static_cast<std::ptrdiff_t>(end),
                                  [](const TraceChoice& c) { return c.normal || c.tangential; });
    if (held && !wide.contains(points[i].node)) add_node(set, state, i, end);
    i = end;
  }
  oblique_ = wide_.any() || part.node_map.any(std::any_of(nodes_.begin(), nodes_.end(),
                                                          [](const Node& n) { return n.slides; }));
}

void HeldNodes::add_node(const ActiveSet& set, const ContactState& state, std::size_t first,
                         std::size_t last) {
  const auto points = part_->contact.points();
  const auto tangent_of = [&](std::size_t i, std::size_t k) {
    return to_eigen(part_->contact.entries(i)[0].tangent[k]);
  };
  std::vector<Eigen::Vector3d> tangents;  // of sticking points
  std::vector<double> weights, normal_gaps, slips;
  MatrixXd normals(3, 0);
  Node node{points[first].node, rows_.size(), 0, false, {}, {}};
  double strength = 0.0;
  for (std::size_t i = first; i < last; ++i) strength = std::max(strength, points[i].mass * state.bound[i]);
  for (std::size_t i = first; i < last; ++i) {
    if (!set.held[i].normal) continue;
    normals.conservativeResize(3, normals.cols() + 1);
    normals.col(normals.cols() - 1) = to_eigen(part_->contact.entries(i)[0].trace);
    normal_gaps.push_back(state.gap[i] - state.trace.normal[i]);
    rows_.push_back({static_cast<std::int32_t>(i), -1, {}});
  }
  const auto held_normals = static_cast<Eigen::Index>(normals.cols());
  const MatrixXd back = pseudo_inverse(normals.transpose(), dependent);
  const Eigen::Matrix3d free = Eigen::Matrix3d::Identity() - back * normals.transpose();
  const Eigen::Vector3d closing = back * Eigen::Map<VectorXd>(normal_gaps.data(), held_normals);
  for (std::size_t i = first; i < last; ++i) {
    if (!set.held[i].tangential) continue;
    for (std::size_t k = 0; k < static_cast<std::size_t>(points[i].tangents); ++k) {
      const Eigen::Vector3d t = tangent_of(i, k);
      tangents.push_back(free * t);
      weights.push_back(strength > 0.0 ? points[i].mass * state.bound[i] + 1e-6 * strength : points[i].mass);
      slips.push_back(state.trace.tangential[2 * i + k] + t.dot(closing));
      rows_.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k), {}});
    }
  }
  const auto sticking = static_cast<Eigen::Index>(tangents.size());
  MatrixXd along(3, sticking);
  for (Eigen::Index k = 0; k < sticking; ++k) along.col(k) = tangents[k];
  // Orthonormal basis of the sticking directions, and the share of each row in a force along it.
  const SymmetricEigen eigen = symmetric_eigen(along * along.transpose());
  Eigen::Index rank = 0;
  while (rank < 3 && eigen.values(2 - rank) > dependent) ++rank;
  const MatrixXd basis = eigen.vectors.rightCols(rank);
  const MatrixXd seen = along.transpose() * basis;  // rows × rank
  const VectorXd weight = Eigen::Map<VectorXd>(weights.data(), sticking);
  const MatrixXd shares =
      rank > 0 ? MatrixXd(weight.asDiagonal() * seen * inverse(seen.transpose() * weight.asDiagonal() * seen))
               : MatrixXd(sticking, rank);
  Eigen::Vector3d all = closing;
  if (rank > 0)
    all -= basis * (pseudo_inverse(seen, dependent) * Eigen::Map<VectorXd>(slips.data(), sticking));
  node.closing = from_eigen(all);

  // Reactions x along q and along the basis: C [q, basis] x = C force with C = [normals, basis]ᵀ.
  MatrixXd rows(3, held_normals + rank), directions(3, held_normals + rank);
  rows << normals, basis;
  directions = rows;
  MatrixXd sliding = MatrixXd::Zero(3, held_normals);
  for (Eigen::Index k = 0; k < held_normals; ++k) {
    const std::size_t i = rows_[node.first + static_cast<std::size_t>(k)].point;
    if (set.coulomb[i] == 0.0) continue;
    node.slides = true;
    for (std::size_t t = 0; t < static_cast<std::size_t>(points[i].tangents); ++t)
      sliding.col(k) += set.coulomb[i] * set.slip_direction[2 * i + t] * tangent_of(i, t);
  }
  directions.leftCols(held_normals) += sliding;
  const MatrixXd react = pseudo_inverse(rows.transpose() * directions, dependent) * rows.transpose();
  const MatrixXd friction = shares * react.bottomRows(rank);
  for (Eigen::Index k = 0; k < held_normals; ++k)
    rows_[node.first + static_cast<std::size_t>(k)].react = from_eigen(react.row(k).transpose());
  for (Eigen::Index k = 0; k < sticking; ++k)
    rows_[node.first + static_cast<std::size_t>(held_normals + k)].react =
        from_eigen(friction.row(k).transpose());
  const Eigen::Matrix3d taken = sliding * react.topRows(held_normals);
  for (Eigen::Index c = 0; c < 3; ++c) node.sliding[c] = from_eigen(taken.row(c).transpose());
  node.last = rows_.size();
  nodes_.push_back(node);
}

double HeldNodes::close(std::span<double> delta) const {
  const std::size_t dim = part_->dim();
  double furthest = 0.0;
  for (const Node& node : nodes_)
    for (std::size_t c = 0; c < dim; ++c) {
      delta[static_cast<std::size_t>(node.node) * dim + c] = node.closing[c];
      furthest = std::max(furthest, std::abs(node.closing[c]));
    }
  return part_->node_map.max_all(furthest);
}

void HeldNodes::subtract_sliding(std::span<double> force) const {
  wide_.subtract(force);
  const std::size_t dim = part_->dim();
  for (const Node& node : nodes_) {
    if (!node.slides) continue;
    double* f = force.data() + static_cast<std::size_t>(node.node) * dim;
    Vector3 taken{};
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t d = 0; d < dim; ++d) taken[c] += node.sliding[c][d] * f[d];
    for (std::size_t c = 0; c < dim; ++c) f[c] -= taken[c];
  }
}

void HeldNodes::reactions(std::span<const double> force, ContactValues& lambda) const {
  wide_.reactions(force, lambda);
  const std::size_t dim = part_->dim();
  for (const Node& node : nodes_) {
    const double* f = force.data() + static_cast<std::size_t>(node.node) * dim;
    for (std::size_t r = node.first; r < node.last; ++r) {
      const Row& row = rows_[r];
      const std::size_t i = row.point;
      double value = 0.0;
      for (std::size_t c = 0; c < dim; ++c) value += row.react[c] * f[c];
      value /= part_->contact.points()[i].mass;
      if (row.component < 0)
        lambda.normal[i] = value;
      else
        lambda.tangential[2 * i + static_cast<std::size_t>(row.component)] = value;
    }
  }
}

}  // namespace kacanov
