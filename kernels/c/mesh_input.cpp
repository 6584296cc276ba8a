// SPDX-License-Identifier: BSD-3-Clause
// Node orders from the table of cells; inverted elements are reflected by swapping two reference coordinates.
#include "c/mesh_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <kacanov/cells.hpp>
#include "c/laws.hpp"
#include "operator/mesh_check.hpp"

namespace kacanov::c_api {
namespace {

std::vector<std::int8_t> mirror_image(const Cell& cell) {
  std::vector<std::int8_t> of(cell.nodes);
  for (int a = 0; a < cell.nodes; ++a)
    for (int b = 0; b < cell.nodes; ++b) {
      const auto &p = cell.reference[a], &q = cell.reference[b];
      if (std::abs(p[0] - q[1]) + std::abs(p[1] - q[0]) + std::abs(p[2] - q[2]) < 1e-9)
        of[a] = static_cast<std::int8_t>(b);
    }
  return of;
}

}  // namespace

std::vector<std::int8_t> node_order(const char* name, ElementType type) {
  if (name == nullptr) return {};
  const std::string_view wanted = name;
  const Cell& facts = cell(type);
  const auto list = [](std::span<const std::int8_t> order) {
    return std::vector<std::int8_t>(order.begin(), order.end());
  };
  if (wanted == "gmsh") return {};
  if (wanted == "vtk") return list(facts.vtk_order);
  if (wanted == "basix") return list(facts.basix_order);
  if (wanted == "dealii") {
    if (facts.order != 1)
      throw Fault(KACANOV_ERROR_VALUE,
                  "node_order: deal.II's cells have their vertices only, not the nodes of " +
                      std::string(facts.name));
    return list(facts.basix_order);  // both are lexicographic
  }
  throw Fault(KACANOV_ERROR_VALUE, "node_order: expected gmsh, vtk, basix or dealii, got '" +
                                       std::string(wanted.substr(0, 40)) + "'");
}

void turn_inverted(const MeshView& mesh, std::span<std::int32_t> connectivity) {
  const auto mirror = mirror_image(cell(mesh.type));
  std::array<std::int32_t, most_nodes> turned{};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    if (!is_inverted(mesh, e)) continue;
    const auto nodes = connectivity.subspan(e * mirror.size(), mirror.size());
    for (std::size_t a = 0; a < mirror.size(); ++a) turned[a] = nodes[mirror[a]];
    std::copy_n(turned.begin(), mirror.size(), nodes.begin());
  }
}

std::vector<std::int32_t> orphans(const MeshView& mesh) {
  std::vector<char> used(mesh.node_count(), 0);
  for (const std::int32_t node : mesh.connectivity) used[node] = 1;
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] == 0) result.push_back(static_cast<std::int32_t>(i));
  return result;
}

}  // namespace kacanov::c_api
