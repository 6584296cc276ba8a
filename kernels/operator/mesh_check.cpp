// SPDX-License-Identifier: BSD-3-Clause
// Checks of mesh arrays from outside before a kernel uses them.
#include "operator/mesh_check.hpp"

#include <cmath>
#include <cstddef>
#include <span>

#include "operator/element_maps.hpp"
#include "operator/jacobian_sign.hpp"

namespace kacanov {
namespace {

std::string element_fault(const MeshView& mesh) {
  constexpr double flat = 1e-14;  // size of the determinant's rounding error
  std::string fault;
  visit_element_maps(mesh, [&](std::size_t first, std::span<const ElementMap> maps) {
    for (std::size_t k = 0; k < maps.size() && fault.empty(); ++k) {
      const std::string name = "element " + std::to_string(first + k);
      if (!(maps[k].thinness > flat))
        fault = name + (maps[k].thinness < -flat ? " is inverted (nodes in the wrong order?)"
                                                 : " is degenerate: it has no volume");
      else if (find_negative_jacobian(mesh, first + k))
        fault = name + " is folded: its Jacobian is not positive everywhere (nodes in the wrong order?)";
    }
  });
  return fault;
}

}  // namespace

std::string arrays_fault(const MeshView& mesh) {
  const std::size_t dim = dimension(mesh.type);
  const std::size_t nodes = nodes_per_element(mesh.type);
  if (mesh.coordinates.size() % dim != 0)
    return "coordinates: expected a multiple of " + std::to_string(dim) + " values";
  if (mesh.connectivity.size() % nodes != 0)
    return "connectivity: expected a multiple of " + std::to_string(nodes) + " indices";
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    if (!std::isfinite(mesh.coordinates[i]))
      return "coordinates: those of node " + std::to_string(i / dim) + " are not finite";
  for (std::size_t i = 0; i < mesh.connectivity.size(); ++i) {
    const std::int32_t node = mesh.connectivity[i];
    if (node < 0 || static_cast<std::size_t>(node) >= mesh.node_count())
      return "connectivity: element " + std::to_string(i / nodes) + " refers to node " +
             std::to_string(node) + ", counted from 0; the body has " + std::to_string(mesh.node_count());
  }
  if (mesh.plane != PlaneState::strain && dim != 2)
    return "plane: expected plane strain, as the mesh is not flat";
  for (std::size_t i = 0; i < mesh.node_count() && mesh.plane == PlaneState::axisymmetric; ++i)
    if (mesh.coordinates[2 * i] < 0.0)
      return "coordinates: node " + std::to_string(i) + " of an axisymmetric mesh has a radius below 0";
  return {};
}

std::string mesh_fault(const MeshView& mesh) {
  if (std::string fault = arrays_fault(mesh); !fault.empty()) return fault;
  return element_fault(mesh);
}

bool is_inverted(const MeshView& mesh, std::size_t element) {
  return element_map(mesh, element).most_det < 0.0;
}

}  // namespace kacanov
