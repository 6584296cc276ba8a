// SPDX-License-Identifier: BSD-3-Clause
// Response of a part by the reference operator, free thermal strains, and the mean dilatation at corners.
#include "linear/reference_response.hpp"

#include <numeric>

#include <kacanov/reference.hpp>
#include "cells/elements.hpp"
#include "cells/straight.hpp"
#include "law/plane_stress.hpp"
#include "operator/nodal_pressure.hpp"
#include "reference/element_points.hpp"

namespace kacanov {

namespace {

/// Same as reference::corner_changes(), with one Jacobian per element with straight sides instead of one per
/// point.
void sum_changes(const Body& body, const CornerMeans& means, std::span<const double> u,
                 std::span<double> change, std::span<double> volume) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (E::corner_dilatation)
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const std::int32_t* entry = &means.of_element[e * E::corners];
        if (entry[0] < 0) continue;
        const elements::CornerIntegrals<E> of =
            elements::corner_integrals<E>(elements::coordinates_of<E>(body.mesh, e));
        const elements::Nodal<E> local = reference::gather<E>(body, e, u);
        for (std::size_t c = 0; c < E::corners; ++c) {
          double sum = 0.0;
          for (std::size_t a = 0; a < E::nodes; ++a)
            for (std::size_t k = 0; k < 3; ++k) sum += of.change[a][c][k] * local[3 * a + k];
          change[entry[c]] += sum, volume[entry[c]] += of.volume[c];
        }
      }
  });
}

}  // namespace

std::vector<double> free_strain(const Part& part, std::span<const double> pressure) {
  return part.plane == PlaneState::stress && !pressure.empty() ? free_strain(part.body(), pressure)
                                                               : std::vector<double>();
}

std::vector<double> free_strain(const Body& body, std::span<const double> pressure) {
  std::vector<double> strain(pressure.begin(), pressure.end());
  for (std::size_t e = 0; e < strain.size(); ++e) strain[e] /= plane_stress_expansion(body.law(e));
  return strain;
}

double reference_response(const Part& part, const ReferenceState& state, std::span<double> internal) {
  const auto& [u, strain, dilatation] = state;
  Body body = part.body();
  body.free_strain = strain;
  body.corner_dilatation = dilatation;
  const double energy = reference::response(body, u, internal);
  if (strain.empty()) return energy;
  std::vector<double> load(part.unknowns());
  const double free = reference::free_force(body, load);
  for (std::size_t i = 0; i < load.size(); ++i) internal[i] += load[i];
  return std::inner_product(load.begin(), load.end(), u.begin(), energy - free);
}

std::vector<double> corner_dilatation(const Part& part, std::span<const double> u) {
  const Body body = part.body();
  if (corner_moduli(body).empty()) return {};
  const CornerMeans means = corner_means(body);
  std::vector<double> change(means.size()), volume(means.size());
  sum_changes(body, means, u, change, volume);
  CornerSum<double> sum(means, part.node_map);
  sum(change), sum(volume);
  std::vector<double> of_element(means.of_element.size(), 0.0);
  for (std::size_t k = 0; k < of_element.size(); ++k)
    if (const std::int32_t entry = means.of_element[k]; entry >= 0)
      of_element[k] = change[entry] / volume[entry];
  return of_element;
}

}  // namespace kacanov
