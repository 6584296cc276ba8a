// SPDX-License-Identifier: BSD-3-Clause
// The way to the full load: a part of a problem under a share of it.
#include "nonlinear/load_path.hpp"

#include <algorithm>
#include <utility>

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

LoadPath::LoadPath(Part& part) : part_(part), load_(part.load), prescribed_(part.prescribed) {
  std::int32_t entries = 0;
  for (const ContactPoint& point : part.contact) {
    gap_.push_back(point.gap);
    closed_.push_back(closed_by_prescription(part, point));
    entries = std::max(entries, point.entry + 1);
  }
  depth_.assign(static_cast<std::size_t>(part.halo.max_all(entries)), 0.0);
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    double& depth = depth_[static_cast<std::size_t>(part.contact[i].entry)];
    depth = std::max(depth, -(gap_[i] + closed_[i]));
  }
  for (double& depth : depth_) depth = part.halo.max_all(depth);
}

LoadPath::~LoadPath() {
  part_.load = std::move(load_);
  part_.prescribed = std::move(prescribed_);
  for (std::size_t i = 0; i < gap_.size(); ++i) part_.contact[i].gap = gap_[i];
}

void LoadPath::set(double factor) {
  const double missing = 1.0 - factor;
  for (std::size_t i = 0; i < load_.size(); ++i) part_.load[i].value = factor * load_[i].value;
  for (std::size_t i = 0; i < prescribed_.size(); ++i)
    part_.prescribed[i].value = factor * prescribed_[i].value;
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    ContactPoint& point = part_.contact[i];
    point.gap = gap_[i] + missing * (closed_[i] + depth_[static_cast<std::size_t>(point.entry)]);
  }
}

}  // namespace kacanov
