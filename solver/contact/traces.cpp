// SPDX-License-Identifier: BSD-3-Clause
// Normal and tangential traces N, T at the contact points, with the lumped mass M.
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

void Traces::evaluate(std::span<const double> u, ContactValues& values) const {
  const std::size_t dim = part_->dim();
  const auto all = points();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t tangents = all[i].tangents;
    double normal = 0.0, tangential[2] = {0.0, 0.0};
    for (const RowEntry& entry : entries(i)) {
      const double* at = u.data() + static_cast<std::size_t>(entry.node) * dim;
      normal += inner(entry.trace, at, dim);
      for (std::size_t k = 0; k < tangents; ++k) tangential[k] += inner(entry.tangent[k], at, dim);
    }
    values.normal[i] = normal;
    for (std::size_t k = 0; k < tangents; ++k) values.tangential[2 * i + k] = tangential[k];
  }
}

void Traces::add_force(const ContactValues& lambda, double factor, std::span<double> y) const {
  const std::size_t dim = part_->dim();
  const auto all = points();
  Vector wide = wide_.zeros(dim);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double m = factor * all[i].mass;
    const bool is_wide = part_->contact.is_wide(i);
    for (const RowEntry& entry : entries(i)) {
      double* f = is_wide ? &wide[wide_.position(entry.node) * dim]
                          : y.data() + static_cast<std::size_t>(entry.node) * dim;
      for (std::size_t c = 0; c < dim; ++c) f[c] += m * lambda.normal[i] * entry.trace[c];
      for (std::size_t k = 0; k < static_cast<std::size_t>(all[i].tangents); ++k)
        for (std::size_t c = 0; c < dim; ++c) f[c] += m * lambda.tangential[2 * i + k] * entry.tangent[k][c];
    }
  }
  if (part_->wide_contact) wide_.add(wide, y);
}

double Traces::add_penalty(const Penalty& r, std::span<const double> x, std::span<double> y) const {
  const std::size_t dim = part_->dim();
  Vector wide = wide_.zeros(dim);
  double share = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const auto& point = points()[i];
    const auto here = entries(i);
    const bool is_wide = here.size() > 1;
    const auto add = [&](double penalty, const auto& row) {
      double value = 0.0;
      for (const RowEntry& entry : here)
        value += inner(row(entry), x.data() + static_cast<std::size_t>(entry.node) * dim, dim);
      const double force = penalty * point.mass * value;
      for (const RowEntry& entry : here) {
        double* f = is_wide ? &wide[wide_.position(entry.node) * dim]
                            : y.data() + static_cast<std::size_t>(entry.node) * dim;
        for (std::size_t c = 0; c < dim; ++c) f[c] += force * row(entry)[c];
      }
      if (i < owned()) share += force * value;
    };
    add(r.normal, [](const RowEntry& entry) -> const Vector3& { return entry.trace; });
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      add(r.tangential, [k](const RowEntry& entry) -> const Vector3& { return entry.tangent[k]; });
  }
  if (part_->wide_contact) wide_.add(wide, y);
  return share;
}

double Traces::force_norm(const ContactValues& lambda) const {
  double sum = 0.0;
  if (part_->wide_contact) {
    Vector force(part_->unknowns(), 0.0);
    add_force(lambda, 1.0, force);
    for (std::size_t i = 0; i < part_->owned_unknowns(); ++i) sum += force[i] * force[i];
    return std::sqrt(ranks().sum_all(sum));
  }
  // Points of one node are contiguous; their forces are summed before the norm is taken.
  const auto all = points().first(owned());
  Vector3 force{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& point = all[i];
    const RowEntry& entry = entries(i).front();
    if (i == 0 || all[i - 1].node != point.node) force = {};
    for (std::size_t c = 0; c < 3; ++c) {
      force[c] += point.mass * lambda.normal[i] * entry.trace[c];
      for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
        force[c] += point.mass * lambda.tangential[2 * i + k] * entry.tangent[k][c];
    }
    if (i + 1 == all.size() || all[i + 1].node != point.node)
      sum += force[0] * force[0] + force[1] * force[1] + force[2] * force[2];
  }
  return std::sqrt(ranks().sum_all(sum));
}

}  // namespace kacanov
