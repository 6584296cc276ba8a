// SPDX-License-Identifier: BSD-3-Clause
// Pressures of averaged tr ε as distributed rows, around corners or element by element (B-bar).
#include "multigrid/pressure_rows.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "cells/elements.hpp"
#include "cells/point.hpp"
#include "operator/nodal_pressure.hpp"
#include "operator/threads.hpp"

namespace kacanov {

using elements::Hex8;

bool averages_over_elements(const Body& body) noexcept {
  return body.mesh.type == Hex8::type &&
         std::any_of(body.laws.begin(), body.laws.end(), [](const Law& law) { return law.mean_dilatation; });
}

CornerMeans element_means(const Body& body) {
  CornerMeans means;
  means.has_patches = true;
  for (const Law& law : body.laws)
    if (law.mean_dilatation) means.moduli.push_back(law.bulk);
  std::sort(means.moduli.begin(), means.moduli.end());
  means.moduli.erase(std::unique(means.moduli.begin(), means.moduli.end()), means.moduli.end());
  means.of_element.assign(Hex8::corners * body.mesh.element_count(), -1);
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const Law& law = body.law(e);
    if (!law.mean_dilatation) continue;
    std::fill_n(&means.of_element[Hex8::corners * e], Hex8::corners, static_cast<std::int32_t>(means.size()));
    means.place.push_back(static_cast<std::int64_t>(e));
    const auto at = std::lower_bound(means.moduli.begin(), means.moduli.end(), law.bulk);
    means.modulus.push_back(static_cast<std::int32_t>(at - means.moduli.begin()));
  }
  return means;
}

CornerRows element_rows(const CornerMeans& means, const Body& body, const IndexMap& nodes) {
  CornerRows rows;
  static_cast<Communicator&>(rows.map) = nodes;
  rows.map.owned = static_cast<std::int32_t>(means.size());
  rows.map.starts = number_owned(rows.map.owned, nodes);
  rows.of_entry.resize(means.size());
  std::iota(rows.of_entry.begin(), rows.of_entry.end(), 0);
  rows.modulus = means.modulus;
  for (const std::int64_t e : means.place)
    rows.node.push_back(body.mesh.connectivity[Hex8::nodes * static_cast<std::size_t>(e)]);
  return rows;
}

ElementChanges::ElementChanges(const Body& body, const CornerMeans& means, int threads)
    : threads_(threads),
      node_(nodes * means.size()),
      change_(3 * node_.size()),
      first_(body.mesh.node_count() + 1, 0),
      use_(node_.size()) {
  each_in_shares(threads, means.size(), [&](std::size_t k) {
    const auto e = static_cast<std::size_t>(means.place[k]);
    std::copy_n(&body.mesh.connectivity[nodes * e], nodes, &node_[nodes * k]);
    const auto x = elements::coordinates_of<Hex8>(body.mesh, e);
    std::array<double, 3 * nodes> sum{};
    for (std::size_t q = 0; q < Hex8::points; ++q) {
      const elements::Point<Hex8> point(x, q);
      for (std::size_t a = 0; a < nodes; ++a)
        for (std::size_t i = 0; i < 3; ++i) sum[3 * a + i] += point.volume * point.gradient[a][i];
    }
    std::copy(sum.begin(), sum.end(), &change_[3 * nodes * k]);
  });
  for (const std::int32_t node : node_) ++first_[node + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::int64_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < node_.size(); ++k) use_[next[node_[k]]++] = static_cast<std::int32_t>(k);
}

void ElementChanges::volume_change(std::span<const float> x, std::span<float> q) const {
  each_in_shares(threads_, q.size(), [&](std::size_t k) {
    float sum = 0.0F;
    for (std::size_t a = 0; a < nodes; ++a) {
      const float* from = &x[3 * node_[nodes * k + a]];
      const float* change = &change_[3 * (nodes * k + a)];
      sum += change[0] * from[0] + change[1] * from[1] + change[2] * from[2];
    }
    q[k] = sum;
  });
}

void ElementChanges::add_force(std::span<const float> p, std::span<float> y) const {
  each_in_shares(threads_, first_.size() - 1, [&](std::size_t n) {
    for (std::int64_t u = first_[n]; u < first_[n + 1]; ++u) {
      const std::size_t k = use_[u];
      for (std::size_t i = 0; i < 3; ++i) y[3 * n + i] += change_[3 * k + i] * p[k / nodes];
    }
  });
}

std::size_t ElementChanges::bytes() const noexcept {
  return node_.size() * sizeof(std::int32_t) + change_.size() * sizeof(float) +
         first_.size() * sizeof(std::int64_t) + use_.size() * sizeof(std::int32_t);
}

namespace {

CornerMeans means_of(const Body& body) {
  return averages_over_elements(body) ? element_means(body) : corner_means(body);
}

CornerRows rows_of(const MultigridBody& body, const CornerMeans& means) {
  return averages_over_elements(body.body) ? element_rows(means, body.body, *body.node_map)
                                           : make_corner_rows(means, *body.node_map);
}

}  // namespace

PressureRows::PressureRows(const MultigridBody& body)
    : means_(means_of(body.body)),
      rows_(std::make_unique<const CornerRows>(rows_of(body, means_))),
      scatterer_(rows_->map, 1),
      compliance_(rows()),
      values_(rows_->map.size()) {
  const std::vector<double> volume = corner_volumes(body.body, means_);
  const std::vector<float> share(volume.begin(), volume.end());
  sum(share, compliance_);
  for (std::size_t r = 0; r < rows(); ++r) compliance_[r] /= means_.moduli[rows_->modulus[r]];
}

void PressureRows::sum(std::span<const float> entries, std::span<double> rows) {
  std::fill(values_.begin(), values_.end(), 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e)
    values_[rows_->of_entry[e]] = static_cast<double>(entries[e]);
  scatterer_.start_sum(values_), scatterer_.finish_sum(values_);
  std::copy_n(values_.begin(), rows.size(), rows.begin());
}

void PressureRows::spread(std::span<const double> rows, std::span<float> entries) {
  std::copy(rows.begin(), rows.end(), values_.begin());
  scatterer_.start_forward(values_), scatterer_.finish_forward(values_);
  for (std::size_t e = 0; e < entries.size(); ++e)
    entries[e] = static_cast<float>(values_[rows_->of_entry[e]]);
}

std::size_t PressureRows::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(rows_->of_entry) + size(rows_->node) + size(rows_->modulus) + size(compliance_) +
         size(values_) + size(means_.place) + size(means_.modulus) + size(means_.of_element);
}

}  // namespace kacanov
