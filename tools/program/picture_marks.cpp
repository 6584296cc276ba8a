// SPDX-License-Identifier: BSD-3-Clause
// Marks of supports and loads in the picture of a body.
#include "program/picture_marks.hpp"

#include <kacanov/error.hpp>
#include "problem/selection.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

using Mark = DeformedPicture::Mark;

/// Outward normal of a facet, from its corners; its length is twice the area in 3D and the edge length in 2D.
Vector3 outwards(const Mesh& mesh, std::size_t facet) {
  const auto nodes = mesh.facet(facet);
  const std::size_t dim = mesh.dim();
  const auto corner = [&](std::size_t k) {
    Vector3 x{};
    for (std::size_t c = 0; c < dim; ++c)
      x[c] = mesh.coordinates[static_cast<std::size_t>(nodes[k]) * dim + c];
    return x;
  };
  if (dim == 2) {
    const Vector3 along = corner(1) - corner(0);
    return {along[1], -along[0], 0.0};
  }
  return cross(corner(1) - corner(0), corner(2) - corner(0));
}

/// Direction of a load at each node of `nodes`.
std::vector<Vector3> directions(const BoundaryEntry& entry, const Mesh& mesh, const Selection& selection,
                                const std::string& name, const std::vector<std::int32_t>& nodes) {
  Vector3 same{};
  for (const auto& load : {entry.traction, entry.total_force, entry.node_force})
    if (load) same = *load;
  std::vector<Vector3> all(nodes.size(), same);
  if (!entry.pressure) return all;
  const double sign = *entry.pressure < 0.0 ? 1.0 : -1.0;
  for (const std::int32_t facet : selection.facets(entry.on, name)) {
    const Vector3 push = sign * outwards(mesh, static_cast<std::size_t>(facet));
    for (const std::int32_t node : mesh.facet(static_cast<std::size_t>(facet))) {
      const auto place = std::lower_bound(nodes.begin(), nodes.end(), node);
      if (place != nodes.end() && *place == node) {
        Vector3& at = all[static_cast<std::size_t>(place - nodes.begin())];
        at = at + push;
      }
    }
  }
  return all;
}

}  // namespace

std::vector<Mark> picture_marks(const Case& input, const Mesh& mesh) {
  const Selection selection(mesh);
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < input.model.boundary.size(); ++i) {
    const BoundaryEntry& entry = input.model.boundary[i];
    if (entry.body_force || entry.temperature) continue;
    const std::string name = entry_name(entry, i);
    const Mark::Kind kind = entry.is_support()  ? Mark::Kind::support
                            : entry.is_spring() ? Mark::Kind::spring
                                                : Mark::Kind::load;
    try {
      const std::vector<std::int32_t> nodes = selection.nodes(entry.on, name);
      std::vector<Vector3> along(nodes.size());
      if (kind == Mark::Kind::load) along = directions(entry, mesh, selection, name, nodes);
      for (std::size_t k = 0; k < nodes.size(); ++k) marks.push_back({kind, nodes[k], along[k]});
    } catch (const InputError&) {  // inner nodes, which the boundary does not have
    }
  }
  return marks;
}

}  // namespace kacanov
