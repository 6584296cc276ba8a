// SPDX-License-Identifier: BSD-3-Clause
// Projection and inner products of the space of a linear solve.
#include "linear/space.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

Space::Space(const Part& part) : part_(&part) {
  for (const HeldDirection& direction : part.directions) {
    auto& held = held_.directions;
    if (held.empty() || held.back().node != direction.node) held.push_back({direction.node, 0, {}});
    held.back().basis[held.back().count++] = direction.direction;
  }
  prescribed_ = held_.directions.size();
}

HeldDirections& Space::directions_at(std::int32_t node) {
  auto& held = held_.directions;
  const auto end = held.begin() + static_cast<std::ptrdiff_t>(prescribed_);
  const auto there = std::lower_bound(held.begin(), end, node,
                                      [](const HeldDirections& d, std::int32_t n) { return d.node < n; });
  if (there != end && there->node == node) return *there;
  // Points of one node are contiguous in Part::contact, so checking the last entry suffices.
  if (held.size() == prescribed_ || held.back().node != node) held.push_back({node, 0, {}});
  return held.back();
}

void Space::hold(std::int32_t node, const Vector3& direction) {
  HeldDirections& entry = directions_at(node);
  const std::size_t dim = part_->dim();
  Vector3 d = direction;
  for (std::size_t c = 0; c < dim; ++c)
    if (part_->held[static_cast<std::size_t>(node) * dim + c]) d[c] = 0.0;
  const auto inner = [](const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const double length = std::sqrt(inner(d, d));
  if (length == 0.0) return;
  for (int pass = 0; pass < 2; ++pass)
    for (int k = 0; k < entry.count; ++k) {
      const auto& b = entry.basis[k];
      const double s = inner(d, b);
      for (std::size_t c = 0; c < 3; ++c) d[c] -= s * b[c];
    }
  const double rest = std::sqrt(inner(d, d));
  if (rest <= 1e-8 * length || entry.count == 3) return;  // depends on directions that are held already
  for (double& c : d) c /= rest;
  entry.basis[entry.count++] = d;
}

void Space::project(std::span<double> x) const {
  for (const auto& entry : part_->prescribed) x[entry.component] = 0.0;
  held_.project(part_->dim(), x);
}

double Space::local_dot(std::span<const double> x, std::span<const double> y) const {
  return eight_sums(part_->owned_unknowns(), [&](std::size_t i) { return x[i] * y[i]; });
}

double Space::dot(std::span<const double> x, std::span<const double> y, CallSite at) const {
  return part_->node_map.sum_all(local_dot(x, y), at);
}

double Space::norm(std::span<const double> x, CallSite at) const { return std::sqrt(dot(x, x, at)); }

double Space::residual_norm(std::span<const double> r, CallSite at) const {
  if (!weighted()) return norm(r, at);
  const std::size_t dim = part_->dim();
  double square = 0.0;
  for (std::size_t n = 0; n < static_cast<std::size_t>(part_->owned_nodes()); ++n) {
    double here = 0.0;
    for (std::size_t i = n * dim; i < (n + 1) * dim; ++i) here += r[i] * r[i];
    square += weights_->at(n) * weights_->at(n) * here;
  }
  return std::sqrt(sum_all(square, at));
}

std::array<double, 2> Space::dot2(std::span<const double> a, std::span<const double> b,
                                  std::span<const double> c, std::span<const double> d, CallSite at) const {
  std::array<double, 2> s{local_dot(a, b), local_dot(c, d)};
  part_->node_map.sum_all(s, at);
  return s;
}

double Space::advance(double alpha, std::span<const double> p, std::span<const double> q, std::span<double> x,
                      std::span<double> r) const {
  const auto step = [&](std::size_t i) {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
    return r[i] * r[i];
  };
  const double square = eight_sums(part_->owned_unknowns(), step);
  for (std::size_t i = part_->owned_unknowns(); i < x.size(); ++i) step(i);
  return weighted() ? residual_norm(r) : std::sqrt(sum_all(square));
}

void Space::turn(double beta, std::span<const double> z, std::span<double> p) const {
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = beta == 0.0 ? z[i] : z[i] + beta * p[i];
}

double Space::max_abs(std::span<const double> x, CallSite at) const {
  double m = 0.0;
  for (const double v : x) m = std::max(m, std::abs(v));
  return part_->node_map.max_all(m, at);
}

}  // namespace kacanov
