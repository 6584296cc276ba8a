// SPDX-License-Identifier: BSD-3-Clause
// Volume changes summed at the corners of tetrahedra, or over patches of corners.
#include <kacanov/corner_means.hpp>

#include <algorithm>
#include <utility>

#include "reference/element_points.hpp"

namespace kacanov {

bool averages_at_corners(const Law& law, ElementType type) noexcept {
  return law.mean_dilatation && cell(type).corner_dilatation;
}

std::vector<double> corner_moduli(const Body& body) {
  std::vector<double> moduli;
  for (const Law& law : body.laws)
    if (averages_at_corners(law, body.mesh.type)) moduli.push_back(law.bulk);
  std::sort(moduli.begin(), moduli.end());
  moduli.erase(std::unique(moduli.begin(), moduli.end()), moduli.end());
  return moduli;
}

CornerMeans corner_means(const Body& body) {
  CornerMeans means;
  means.moduli = corner_moduli(body);
  if (means.moduli.empty()) return means;
  const std::size_t elements = body.mesh.element_count(), width = means.moduli.size();
  const std::size_t nodes = nodes_per_element(body.mesh.type), corners = cell(body.mesh.type).corners;
  std::vector<std::ptrdiff_t> of_law;  // index of the modulus, −1 for laws that do not average
  for (const Law& law : body.laws) {
    const auto at = std::lower_bound(means.moduli.begin(), means.moduli.end(), law.bulk);
    of_law.push_back(averages_at_corners(law, body.mesh.type) ? at - means.moduli.begin() : -1);
  }
  // Calls visit(element × corners, node × moduli) for elements that average.
  const auto each = [&](const auto& visit) {
    for (std::size_t e = 0; e < elements; ++e) {
      const std::ptrdiff_t m = of_law[body.law_index(e)];
      for (std::size_t c = 0; m >= 0 && c < corners; ++c)
        visit(e * corners + c, static_cast<std::size_t>(body.mesh.connectivity[e * nodes + c]) * width +
                                   static_cast<std::size_t>(m));
    }
  };
  std::vector<std::int32_t> entry(body.mesh.node_count() * width, -1);
  each([&](std::size_t, std::size_t place) { entry[place] = 0; });
  means.has_patches = !body.pressure_patch.empty();
  std::vector<std::pair<std::int64_t, std::int32_t>> keys;  // place, modulus
  const auto key = [&](std::size_t k) {
    const std::size_t node = k / width;
    return std::pair(means.has_patches ? body.pressure_patch[node] : static_cast<std::int64_t>(node),
                     static_cast<std::int32_t>(k % width));
  };
  // Consecutive nodes often share a patch; without patches all keys differ.
  for (std::size_t k = 0; k < entry.size(); ++k)
    if (entry[k] >= 0 && (keys.empty() || keys.back() != key(k))) keys.push_back(key(k));
  if (!std::is_sorted(keys.begin(), keys.end())) std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::size_t found = 0;
  for (std::size_t k = 0; k < entry.size(); ++k) {
    if (entry[k] < 0) continue;
    if (found + 1 < keys.size() && keys[found + 1] == key(k)) ++found;
    if (keys[found] != key(k)) found = std::lower_bound(keys.begin(), keys.end(), key(k)) - keys.begin();
    entry[k] = static_cast<std::int32_t>(found);
  }
  for (const auto& [where, modulus] : keys) means.place.push_back(where), means.modulus.push_back(modulus);
  means.of_element.assign(elements * corners, -1);
  each([&](std::size_t corner, std::size_t place) { means.of_element[corner] = entry[place]; });
  return means;
}

namespace reference {

void corner_changes(const Body& body, const CornerMeans& means, std::span<const double> u,
                    std::span<double> change, std::span<double> volume) {
  std::fill(change.begin(), change.end(), 0.0);
  std::fill(volume.begin(), volume.end(), 0.0);
  if (means.size() == 0) return;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_plain_point<E>(
        body, u, [&](std::size_t e, const Law&, std::size_t q, const Point<E>& point, const Strain& strain) {
          const auto share = elements::barycentric<E::dim>(E::point[q].data());
          for (std::size_t c = 0; c < share.size(); ++c) {
            const std::int32_t entry = means.of_element[e * share.size() + c];
            if (entry < 0) continue;
            change[entry] += point.volume * share[c] * strain.trace;
            if (!volume.empty()) volume[entry] += point.volume * share[c];
          }
        });
  });
}

CornerDilatation::CornerDilatation(const Body& body, std::span<const double> u, std::span<const double> known)
    : corners_(cell(body.mesh.type).corners), values_(known) {
  if (!known.empty()) return;
  const CornerMeans means = corner_means(body);
  if (means.size() == 0) return;
  std::vector<double> change(means.size()), volume(means.size());
  corner_changes(body, means, u, change, volume);
  own_.assign(means.of_element.size(), 0.0);
  for (std::size_t k = 0; k < own_.size(); ++k)
    if (const std::int32_t entry = means.of_element[k]; entry >= 0) own_[k] = change[entry] / volume[entry];
  values_ = own_;
}

}  // namespace reference
}  // namespace kacanov
