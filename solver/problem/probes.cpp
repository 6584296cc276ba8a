// SPDX-License-Identifier: BSD-3-Clause
// Finds the elements that hold the probe points.
#include "problem/probes.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include <kacanov/error.hpp>
#include "mesh/plain_stream.hpp"
#include "problem/point_location.hpp"
#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// How far outside its element a point may lie, in reference coordinates.
constexpr double probe_slack = 1e-6;

std::string outside_message(const Mesh& mesh, std::size_t index, const Vector3& x) {
  std::int32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto count = static_cast<std::int32_t>(mesh.node_count());
  for (std::int32_t node = 0; node < count; ++node) {
    const double distance = norm(position(mesh, node) - x);
    if (distance < least) {
      least = distance;
      nearest = node;
    }
  }
  PlainText text;
  text << "probe[" << index << "]: the point " << to_text(x, mesh.dim())
       << " lies outside the body; the nearest node, " << mesh.node_tag(nearest) << " at "
       << to_text(position(mesh, nearest), mesh.dim()) << ", is " << least << " away";
  return text.str();
}

}  // namespace

std::vector<Probe> locate_probes(const Mesh& mesh, const Model& model) {
  std::vector<Probe> probes(model.probes.size());
  std::vector<double> best(model.probes.size(), probe_slack);
  for (std::size_t p = 0; p < probes.size(); ++p) {
    probes[p].point = model.probes[p];
    probes[p].element = -1;
  }
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count() && !probes.empty(); ++e) {
    const auto nodes = std::span(mesh.elements).subspan(e * n, n);
    for (std::size_t p = 0; p < probes.size(); ++p) {
      if (!near_element(mesh.view(), nodes, probes[p].point)) continue;
      const std::optional<Vector3> at = reference_point(mesh.view(), nodes, probes[p].point);
      if (!at) continue;
      const double miss = outside(cell(mesh.type), *at);
      if (miss > best[p] || (probes[p].element >= 0 && miss == best[p])) continue;
      best[p] = miss;
      probes[p].element = static_cast<std::int32_t>(e);
      probes[p].weights = shapes_at(cell(mesh.type), *at).value;
    }
  }
  for (std::size_t p = 0; p < probes.size(); ++p) {
    if (probes[p].element < 0) throw InputError(outside_message(mesh, p, probes[p].point));
  }
  return probes;
}

}  // namespace kacanov
