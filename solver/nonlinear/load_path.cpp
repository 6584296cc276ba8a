// SPDX-License-Identifier: BSD-3-Clause
// The way to the full load: what a share of it puts on the body.
#include "nonlinear/load_path.hpp"

#include <algorithm>

namespace kacanov {
namespace {

/// How much of a point's gap the prescribed components of its nodes close: build_problem has taken it off.
double closed_by_prescription(const Part& part, std::span<const RowEntry> entries) {
  const std::size_t dim = part.dim();
  double closed = 0.0;
  for (const RowEntry& entry : entries)
    for (std::size_t c = 0; c < dim; ++c) {
      const std::size_t i = static_cast<std::size_t>(entry.node) * dim + c;
      if (part.held[i]) closed += entry.normal[c] * part.prescribed_at(i);
    }
  return closed;
}

std::vector<Part::ComponentValue> scaled(std::vector<Part::ComponentValue> values, double share) {
  for (auto& entry : values) entry.value *= share;
  return values;
}

}  // namespace

LoadPath::LoadPath(const Part& part) : part_(&part) {
  std::int32_t entries = 0;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    gap_.push_back(part.contact[i].gap);
    missing_.push_back(closed_by_prescription(part, part.contact.entries(i)));
    entries = std::max(entries, part.contact[i].entry + 1);
  }
  // Largest indentation, one a contact entry.
  std::vector<double> depth(static_cast<std::size_t>(part.halo.max_all(entries)), 0.0);
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    double& deepest = depth[part.contact[i].entry];
    deepest = std::max(deepest, -(gap_[i] + missing_[i]));
  }
  for (double& deepest : depth) deepest = part.halo.max_all(deepest);
  for (std::size_t i = 0; i < gap_.size(); ++i) missing_[i] += depth[part.contact[i].entry];
}

void LoadPath::go_to(double share) {
  share_ = share;
  load_ = share == 1.0 ? decltype(load_)() : scaled(part_->load, share);
  prescribed_ = share == 1.0 ? decltype(prescribed_)() : scaled(part_->prescribed, share);
  for (std::size_t i = 0; i < gap_.size(); ++i) gap_[i] = part_->contact[i].gap + (1.0 - share) * missing_[i];
}

}  // namespace kacanov
