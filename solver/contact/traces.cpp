// SPDX-License-Identifier: BSD-3-Clause
// Normal and tangential traces N, T on the contact points, with the lumped mass M.
#include "contact/traces.hpp"

#include <cmath>

namespace kacanov {
namespace {

double inner(const Vector3& row, const double* u, std::size_t dim) {
  double s = 0.0;
  for (std::size_t c = 0; c < dim; ++c) s += row[c] * u[c];
  return s;
}

}  // namespace

void Traces::evaluate(std::span<const double> omega, ContactValues& values) const {
  const auto dim = static_cast<std::size_t>(part_->dim());
  const auto all = points();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double* u = omega.data() + static_cast<std::size_t>(all[i].node) * dim;
    values.normal[i] = inner(all[i].normal, u, dim);
    for (std::size_t k = 0; k < static_cast<std::size_t>(all[i].tangents); ++k)
      values.tangential[2 * i + k] = inner(all[i].tangent[k], u, dim);
  }
}

void Traces::add_force(const ContactValues& lambda, double factor, std::span<double> y) const {
  const auto dim = static_cast<std::size_t>(part_->dim());
  const auto all = points();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& point = all[i];
    double* f = y.data() + static_cast<std::size_t>(point.node) * dim;
    const double m = factor * point.mass;
    for (std::size_t c = 0; c < dim; ++c) f[c] += m * lambda.normal[i] * point.trace[c];
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      for (std::size_t c = 0; c < dim; ++c) f[c] += m * lambda.tangential[2 * i + k] * point.tangent[k][c];
  }
}

double Traces::add_penalty(const Penalty& r, std::span<const double> x, std::span<double> y) const {
  const auto dim = static_cast<std::size_t>(part_->dim());
  double share = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const auto& point = points()[i];
    const double* u = x.data() + static_cast<std::size_t>(point.node) * dim;
    double* f = y.data() + static_cast<std::size_t>(point.node) * dim;
    const auto add = [&](double penalty, const Vector3& row) {
      const double value = inner(row, u, dim), force = penalty * point.mass * value;
      for (std::size_t c = 0; c < dim; ++c) f[c] += force * row[c];
      if (i < owned()) share += force * value;
    };
    add(r.normal, point.trace);
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      add(r.tangential, point.tangent[k]);
  }
  return share;
}

double Traces::force_norm(const ContactValues& lambda) const {
  // Points of one node follow each other; their forces add up before the norm is taken.
  const auto all = points().first(owned());
  double sum = 0.0;
  Vector3 force{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& point = all[i];
    if (i == 0 || all[i - 1].node != point.node) force = {};
    for (std::size_t c = 0; c < 3; ++c) {
      force[c] += point.mass * lambda.normal[i] * point.trace[c];
      for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
        force[c] += point.mass * lambda.tangential[2 * i + k] * point.tangent[k][c];
    }
    if (i + 1 == all.size() || all[i + 1].node != point.node)
      sum += force[0] * force[0] + force[1] * force[1] + force[2] * force[2];
  }
  return std::sqrt(halo().sum_all(sum));
}

double Traces::area() const {
  double sum = 0.0;
  for (const auto& point : points().first(owned())) sum += point.mass;
  return halo().sum_all(sum);
}

}  // namespace kacanov
