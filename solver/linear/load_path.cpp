// SPDX-License-Identifier: BSD-3-Clause
// The load path: loads, prescribed displacements and gaps at a share of the full load.
#include "linear/load_path.hpp"

#include <algorithm>
#include <cmath>

#include "problem/load_curves.hpp"

namespace kacanov {
namespace {

/// Returns the closure of a point's gap by the prescribed components of its nodes with these values (one
/// each), and by prescribed directions with the values of `along`.
template <class Along>
double closed_by_prescription(const Part& part, std::span<const RowEntry> entries,
                              std::span<const Part::ComponentValue> prescribed, const Along& along) {
  const std::size_t dim = part.dim();
  double closed = 0.0;
  if (!part.directions.empty())
    for (const RowEntry& entry : entries)
      for (const HeldDirection& held : directions_of(part.directions, entry.node))
        for (std::size_t c = 0; c < dim; ++c) closed += entry.normal[c] * held.direction[c] * along(held);
  for (const RowEntry& entry : entries)
    for (std::size_t c = 0; c < dim; ++c) {
      const std::size_t i = static_cast<std::size_t>(entry.node) * dim + c;
      if (!part.held[i]) continue;
      closed += entry.normal[c] * prescribed[part.prescribed_place(i)].value;
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
    closed_.push_back(closed_by_prescription(part, part.contact.entries(i), part.prescribed,
                                             [](const HeldDirection& held) { return held.value; }));
    entries = std::max(entries, part.contact[i].entry + 1);
  }
  // Largest indentation per contact entry.
  std::vector<double> depth(static_cast<std::size_t>(part.node_map.max_all(entries)), 0.0);
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    double& deepest = depth[part.contact[i].entry];
    deepest = std::max(deepest, -(gap_[i] + closed_[i]));
  }
  for (double& deepest : depth) deepest = part.node_map.max_all(deepest);
  for (std::size_t i = 0; i < gap_.size(); ++i) depth_.push_back(depth[part.contact[i].entry]);
  if (part.steps.empty()) return;
  find_acting(depth);
  go_to(part.steps.back().time);
}

void LoadPath::find_acting(const std::vector<double>& depth) {
  const LoadFactors& factors = part_->steps.front();
  acts_.assign(factors.boundary.size() + factors.contact.size(), 0);
  for (const EntryForce& force : part_->forces)
    if (force.value != 0.0) acts_[force.entry] = 1;
  for (std::size_t k = 0; k < part_->prescribed.size(); ++k)
    if (part_->prescribed[k].value != 0.0) acts_[part_->prescribed_by[k]] = 1;
  for (const HeldDirection& held : part_->directions)
    if (held.value != 0.0) acts_[held.entry] = 1;
  for (std::size_t e = 0; e < depth.size(); ++e)
    if (depth[e] > 0.0) acts_[factors.boundary.size() + e] = 1;
  for (std::uint8_t& acts : acts_) acts = part_->node_map.any(acts != 0) ? 1 : 0;
}

double LoadPath::factor_of(std::int32_t entry) const {
  return part_->steps.empty() ? share_ : factors_[entry];
}

std::vector<double> LoadPath::thermal_pressure() const {
  std::size_t most = 0;
  for (const ThermalPressure& thermal : part_->thermal) most = std::max(most, thermal.of_element.size());
  std::vector<double> sum(most, 0.0);
  for (const ThermalPressure& thermal : part_->thermal) {
    const double factor = factor_of(thermal.entry);
    // A uniform value also applies at the element's corners.
    const std::size_t each = most / std::max(thermal.of_element.size(), std::size_t{1});
    for (std::size_t k = 0; k < most; ++k) sum[k] += factor * thermal.of_element[k / each];
  }
  return sum;
}

bool LoadPath::idle() const {
  const auto acts = [](const Part::ComponentValue& entry) { return entry.value != 0.0; };
  bool any = std::any_of(load().begin(), load().end(), acts) ||
             std::any_of(prescribed().begin(), prescribed().end(), acts) ||
             std::any_of(gap_.begin(), gap_.end(), [](double gap) { return gap < 0.0; });
  for (const HeldDirection& held : part_->directions) any = any || value_of(held) != 0.0;
  for (const ThermalPressure& thermal : part_->thermal) any = any || factor_of(thermal.entry) != 0.0;
  return !part_->node_map.any(any);
}

double LoadPath::growth_to(double share) const {
  if (part_->steps.empty()) return share / share_;
  const LoadFactors now = factors_at(part_->steps, share_), then = factors_at(part_->steps, share);
  double largest = 0.0, growth = 1.0;
  const auto visit = [&](const auto& look) {
    for (std::size_t e = 0; e < acts_.size(); ++e) {
      const std::size_t c = e - now.boundary.size();
      if (!acts_[e]) continue;
      if (e < now.boundary.size())
        look(now.boundary[e], then.boundary[e]);
      else
        look(now.contact[c], then.contact[c]);
    }
  };
  visit([&](double before, double after) {
    if (std::abs(before) <= largest) return;
    largest = std::abs(before);
    growth = after / before;
  });
  bool in_proportion = true;
  visit([&](double before, double after) {
    in_proportion = in_proportion && std::abs(after - growth * before) <= 1e-12 * std::abs(after);
  });
  return in_proportion ? growth : 1.0;
}

void LoadPath::prescribe(std::span<double> u) const {
  for (const auto& entry : prescribed()) u[entry.component] = entry.value;
  const std::size_t dim = part_->dim();
  for (const HeldDirection& held : part_->directions) {
    double* at = &u[held.node * dim];
    double missing = value_of(held);
    for (std::size_t c = 0; c < dim; ++c) missing -= held.direction[c] * at[c];
    for (std::size_t c = 0; c < dim; ++c) at[c] += missing * held.direction[c];
  }
}

void LoadPath::go_to(double share) {
  share_ = share;
  if (!part_->steps.empty()) return go_along_curves(share);
  whole_ = share == 1.0;
  load_ = whole_ ? decltype(load_)() : scaled(part_->load, share);
  prescribed_ = whole_ ? decltype(prescribed_)() : scaled(part_->prescribed, share);
  for (std::size_t i = 0; i < gap_.size(); ++i)
    gap_[i] = part_->contact[i].gap + (1.0 - share) * (closed_[i] + depth_[i]);
}

void LoadPath::go_along_curves(double time) {
  whole_ = false;
  const LoadFactors factors = factors_at(part_->steps, time);
  factors_ = factors.boundary;
  load_.clear();
  for (const EntryForce& force : part_->forces) {
    if (load_.empty() || load_.back().component != force.component) load_.push_back({force.component, 0.0});
    load_.back().value += factors.boundary[force.entry] * force.value;
  }
  prescribed_ = part_->prescribed;
  for (std::size_t k = 0; k < prescribed_.size(); ++k)
    if (prescribed_[k].value != 0.0) prescribed_[k].value *= factors.boundary[part_->prescribed_by[k]];
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    const ContactPoint& point = part_->contact[i];
    gap_[i] = point.gap + closed_[i] -
              closed_by_prescription(*part_, part_->contact.entries(i), prescribed_,
                                     [&](const HeldDirection& held) { return value_of(held); }) +
              (1.0 - factors.contact[point.entry]) * depth_[i];
  }
}

}  // namespace kacanov
