// SPDX-License-Identifier: BSD-3-Clause
// Length or area of a group of facets.
#pragma once

#include "problem/vector3.hpp"

namespace kacanov::testing {

/// Returns the total length or area of a group of straight facets.
inline double measure(const Mesh& mesh, const Group& group) {
  double sum = 0.0;
  for (const std::int32_t f : group.members) {
    const auto n = mesh.facet(f);
    const Vector3 a = position(mesh, n[0]), b = position(mesh, n[1]);
    if (mesh.dim() == 2) {
      sum += norm(b - a);
      continue;
    }
    const Vector3 c = position(mesh, n[2]);
    sum += norm(cross(b - a, c - a)) * (cell(mesh.type).facet().corners == 4 ? 1.0 : 0.5);
  }
  return sum;
}

}  // namespace kacanov::testing
