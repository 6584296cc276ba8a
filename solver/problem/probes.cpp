// SPDX-License-Identifier: BSD-3-Clause
// Finds the elements that hold the probe points.
#include "problem/probes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>

#include <kacanov/error.hpp>
#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// How far outside its element a point may lie, in reference coordinates.
constexpr double slack = 1e-6;

/// Reference coordinates of x in an element by Newton's method (one step where the map is affine);
/// nothing where it does not converge, as for points far outside a distorted element.
std::optional<Vector3> reference_point(const Mesh& mesh, std::span<const std::int32_t> nodes,
                                       const Vector3& x) {
  const Cell& type = cell(mesh.type);
  Vector3 at{};
  if (type.simplex) at = {0.25, 0.25, mesh.dim() == 3 ? 0.25 : 0.0};
  for (int step = 0; step < 30; ++step) {
    const Shapes shapes = shapes_at(type, at);
    Vector3 miss = x;
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Vector3 node = position(mesh, nodes[k]);
      miss = miss - shapes.value[k] * node;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          jacobian(i, j) += node[i] * shapes.gradient[k][j];
        }
      }
    }
    if (mesh.dim() == 2) jacobian(2, 2) = 1.0;
    const Eigen::Vector3d move = jacobian.partialPivLu().solve(Eigen::Vector3d(miss[0], miss[1], miss[2]));
    at = at + Vector3{move[0], move[1], move[2]};
    if (!(norm(at) < 10.0)) return std::nullopt;
    if (move.norm() < 1e-12) return at;
  }
  return std::nullopt;
}

/// Distance outside the reference element, negative inside.
double outside(const Cell& type, const Vector3& at) {
  double most = -1.0, least = 1.0, rest = 1.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(type.dim); ++c) {
    most = std::max(most, std::abs(at[c]) - 1.0);
    least = std::min(least, at[c]);
    rest -= at[c];
  }
  return type.simplex ? -std::min(least, rest) : most;
}

/// True where x lies in the element's bounding box, grown by half of it: curved elements bulge.
bool near_element(const Mesh& mesh, std::span<const std::int32_t> nodes, const Vector3& x) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(mesh.dim()); ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::int32_t node : nodes) {
      const double value = position(mesh, node)[c];
      low = std::min(low, value);
      high = std::max(high, value);
    }
    const double margin = (cell(mesh.type).order == 2 ? 0.5 : 1e-5) * (high - low);
    if (x[c] < low - margin || x[c] > high + margin) return false;
  }
  return true;
}

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
  std::ostringstream text;
  text << "probe[" << index << "]: the point " << to_text(x, mesh.dim())
       << " lies outside the body; the nearest node, " << mesh.node_tag(nearest) << " at "
       << to_text(position(mesh, nearest), mesh.dim()) << ", is " << least << " away";
  return text.str();
}

}  // namespace

std::vector<Probe> locate_probes(const Mesh& mesh, const Model& model) {
  std::vector<Probe> probes(model.probes.size());
  std::vector<double> best(model.probes.size(), slack);
  for (std::size_t p = 0; p < probes.size(); ++p) {
    probes[p].point = model.probes[p];
    probes[p].element = -1;
  }
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count() && !probes.empty(); ++e) {
    const auto nodes = std::span(mesh.elements).subspan(e * n, n);
    for (std::size_t p = 0; p < probes.size(); ++p) {
      if (!near_element(mesh, nodes, probes[p].point)) continue;
      const std::optional<Vector3> at = reference_point(mesh, nodes, probes[p].point);
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
