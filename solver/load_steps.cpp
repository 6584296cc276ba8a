// SPDX-License-Identifier: BSD-3-Clause
// The way to the full load: the same part of a problem under a share of it.
#include "load_steps.hpp"

#include <algorithm>

namespace kacanov {
namespace {

/// How much of the gap the prescribed components of the node close: build_problem has taken it off.
double closed_by_prescription(const Part& part, const ContactPoint& point) {
  const auto dim = static_cast<std::size_t>(part.dim());
  double closed = 0.0;
  for (std::size_t c = 0; c < dim; ++c) {
    const std::size_t i = static_cast<std::size_t>(point.node) * dim + c;
    if (part.held[i]) closed += point.normal[c] * part.prescribed_at(i);
  }
  return closed;
}

}  // namespace

LoadPath::LoadPath(const Part& full) : full_(&full), part_(full) {
  std::int32_t entries = 0;
  for (const ContactPoint& point : full.contact) entries = std::max(entries, point.entry + 1);
  depth_.assign(static_cast<std::size_t>(full.halo.max_all(entries)), 0.0);
  for (const ContactPoint& point : full.contact) {
    double& depth = depth_[static_cast<std::size_t>(point.entry)];
    depth = std::max(depth, -(point.gap + closed_by_prescription(full, point)));
  }
  for (double& depth : depth_) depth = full.halo.max_all(depth);
}

void LoadPath::set(double factor) {
  const double missing = 1.0 - factor;
  for (std::size_t i = 0; i < part_.load.size(); ++i) part_.load[i] = factor * full_->load[i];
  for (std::size_t i = 0; i < part_.prescribed.size(); ++i) part_.prescribed[i].value = factor * full_->prescribed[i].value;
  for (std::size_t i = 0; i < part_.contact.size(); ++i) {
    const ContactPoint& point = full_->contact[i];
    part_.contact[i].gap =
        point.gap + missing * (closed_by_prescription(*full_, point) + depth_[static_cast<std::size_t>(point.entry)]);
  }
}

}  // namespace kacanov
