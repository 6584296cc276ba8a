// SPDX-License-Identifier: BSD-3-Clause
// Pressures of averaged tr ε, as distributed rows.
#include "multigrid/pressure_rows.hpp"

#include <algorithm>

#include "multigrid/element_pressures.hpp"
#include "operator/nodal_pressure.hpp"

namespace kacanov {
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
