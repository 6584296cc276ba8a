// SPDX-License-Identifier: BSD-3-Clause
// Checks of mesh arrays, sizes, options and bodies.
#include "operator/checks.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "operator/element_maps.hpp"

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

void expect_size(std::size_t actual, std::size_t wanted, const char* what) {
  if (actual != wanted)
    throw std::invalid_argument(std::string(what) + ": expected " + std::to_string(wanted) +
                                " entries, got " + std::to_string(actual));
}

const Body& checked(const Body& body, const OperatorOptions& options) {
  if (const std::string fault = mesh_fault(body.mesh); !fault.empty()) throw std::invalid_argument(fault);
  check_options(body, options);
  check_laws(body);
  return body;
}

void check_options(const Body& body, const OperatorOptions& options) {
  if (options.threads < 1) throw std::invalid_argument("threads: expected at least 1");
  for (const std::int32_t node : options.early)
    if (node < 0 || static_cast<std::size_t>(node) >= body.mesh.node_count())
      throw std::invalid_argument("early: there is no node " + std::to_string(node));
}

void check_laws(const Body& body) {
  if (body.laws.empty()) throw std::invalid_argument("laws: expected at least 1");
  if (!body.law_of_element.empty())
    expect_size(body.law_of_element.size(), body.mesh.element_count(), "law_of_element");
  for (const std::uint16_t law : body.law_of_element)
    if (law >= body.laws.size())
      throw std::invalid_argument("law_of_element: there is no law " + std::to_string(law));
  for (const Law& law : body.laws)
    if (law.mean_dilatation && !cell(body.mesh.type).mean_dilatation &&
        !cell(body.mesh.type).corner_dilatation)
      throw std::invalid_argument(
          "laws: mean dilatation is for " +
          element_names([](const Cell& c) { return c.mean_dilatation || c.corner_dilatation; }) + " only");
  for (const Law& law : body.laws)
    if (law.mean_dilatation && body.mesh.plane == PlaneState::stress)
      throw std::invalid_argument("laws: mean dilatation (B-bar) is not for plane stress");
}

}  // namespace kacanov
