// SPDX-License-Identifier: BSD-3-Clause
// Means of the volume change round the corners of a part's elements.
#include <kacanov/corner_dilatation.hpp>

#include "cells/dispatch.hpp"
#include "cells/straight.hpp"
#include "operator/corner_sum.hpp"
#include "reference/element_points.hpp"

namespace kacanov {
namespace {

/// As reference::corner_changes(), which takes a Jacobian a point where straight sides need one an element.
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
