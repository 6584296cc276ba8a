// SPDX-License-Identifier: BSD-3-Clause
// Locates points in the elements of a mesh.
#include "problem/point_location.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Rounding moves points of shared facets this far outside both elements, in reference coordinates.
constexpr double rounding = 1e-9;

/// Returns bounds of an element along axis c. Edges with a mid-side node are parabolas: the element lies
/// within the convex hull of the corners and the edges' Bézier points, 2 m − (a + b)/2.
std::pair<double, double> reach(const MeshView& mesh, std::span<const std::int32_t> nodes, std::size_t c) {
  const Cell& type = cell(mesh.type);
  const std::size_t dim = type.dim;
  if (c >= dim) return {0.0, 0.0};
  const auto at = [&](int k) {
    return mesh.coordinates[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)]) * dim + c];
  };
  double low = at(0), high = low;
  const auto take = [&](double x) { low = std::min(low, x), high = std::max(high, x); };
  for (int k = 1; k < type.corners; ++k) take(at(k));
  if (type.order == 2)
    for (const CellEdge& edge : type.edges) take(2.0 * at(edge.middle) - 0.5 * (at(edge.a) + at(edge.b)));
  const double margin = 1e-5 * (high - low);
  return {low - margin, high + margin};
}

/// Returns the reference coordinates of x in the simplex of the element's corners.
Vector3 by_corners(const MeshView& mesh, std::span<const std::int32_t> nodes, const Vector3& x) {
  const std::size_t dim = dimension(mesh.type);
  const Vector3 origin = position(mesh, nodes[0]), far = x - origin;
  Eigen::Matrix3d sides = Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < dim; ++k) {
    const Vector3 side = position(mesh, nodes[k + 1]) - origin;
    for (std::size_t c = 0; c < dim; ++c)
      sides(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) = side[c];
  }
  const Eigen::Vector3d at = sides.inverse() * Eigen::Vector3d(far[0], far[1], far[2]);
  return {at[0], at[1], dim == 3 ? at[2] : 0.0};
}

}  // namespace

std::optional<Vector3> reference_point(const MeshView& mesh, std::span<const std::int32_t> nodes,
                                       const Vector3& x) {
  const Cell& type = cell(mesh.type);
  Vector3 at{};
  if (type.simplex) at = by_corners(mesh, nodes, x);
  if (type.simplex && type.order == 1) return at;
  const Vector3 origin = position(mesh, nodes[0]), far = x - origin;
  const double length = norm(far);
  for (int step = 0; step < 30; ++step) {
    if (!(norm(at) < 10.0)) return std::nullopt;
    const Shapes shapes = shapes_at(type, at);
    Vector3 miss = far;
    for (std::size_t k = 1; k < nodes.size(); ++k)
      miss = miss - shapes.value[k] * (position(mesh, nodes[k]) - origin);
    if (norm(miss) <= 1e-14 * length) return at;  // already in the first step if all edges are straight
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const Vector3 side = position(mesh, nodes[k]) - origin;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) jacobian(i, j) += side[i] * shapes.gradient[k][j];
    }
    if (type.dim == 2) jacobian(2, 2) = 1.0;
    const Eigen::Vector3d move = jacobian.inverse() * Eigen::Vector3d(miss[0], miss[1], miss[2]);
    at = at + Vector3{move[0], move[1], move[2]};
    if (move.norm() < 1e-12) return at;
  }
  return std::nullopt;
}

double outside(const Cell& type, const Vector3& at) {
  double most = -1.0, least = 1.0, rest = 1.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(type.dim); ++c) {
    most = std::max(most, std::abs(at[c]) - 1.0);
    least = std::min(least, at[c]);
    rest -= at[c];
  }
  return type.simplex ? -std::min(least, rest) : most;
}

bool near_element(const MeshView& mesh, std::span<const std::int32_t> nodes, const Vector3& x) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(dimension(mesh.type));
       ++c)  // most are outside in the first
    if (const auto [low, high] = reach(mesh, nodes, c); x[c] < low || x[c] > high) return false;
  return true;
}

bool PointLocator::Bounds::has(const Vector3& x, std::size_t dim) const {
  for (std::size_t c = 0; c < dim; ++c)
    if (x[c] < low[c] || x[c] > high[c]) return false;
  return true;
}

PointLocator::PointLocator(const MeshView& mesh) : mesh_(mesh) {
  const std::size_t dim = dimension(mesh.type), npe = nodes_per_element(mesh.type);
  const auto elements = static_cast<std::int32_t>(mesh.connectivity.size() / npe);
  for (std::int32_t e = 0; e < elements; ++e) {
    Bounds& box = bounds_.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) std::tie(box.low[c], box.high[c]) = reach(mesh, nodes(e), c);
  }
  Bounds all = bounds_.front();
  for (const Bounds& box : bounds_)
    for (std::size_t c = 0; c < 3; ++c) {
      all.low[c] = std::min(all.low[c], box.low[c]);
      all.high[c] = std::max(all.high[c], box.high[c]);
    }
  low_ = all.low;
  // One box per four elements: in a uniform mesh an element then overlaps at most eight boxes.
  double volume = 1.0;
  for (std::size_t c = 0; c < dim; ++c) volume *= all.high[c] - all.low[c];
  const double width = std::pow(4.0 * volume / elements, 1.0 / static_cast<double>(dim));
  for (std::size_t c = 0; c < dim; ++c) {
    const double length = all.high[c] - all.low[c];
    count_[c] = std::max<std::int64_t>(1, std::llround(std::min(length / width, 1e5)));
    inverse_[c] = length > 0.0 ? static_cast<double>(count_[c]) / length : 0.0;
  }
  const auto visit = [&](auto&& take) {
    for (std::int32_t e = 0; e < elements; ++e) {
      const Bounds& box = bounds_[e];
      const Cells from = box_of(box.low), to = box_of(box.high);
      for (std::int64_t k = from[2]; k <= to[2]; ++k)
        for (std::int64_t j = from[1]; j <= to[1]; ++j)
          for (std::int64_t i = from[0]; i <= to[0]; ++i) take((k * count_[1] + j) * count_[0] + i, e);
    }
  };
  start_.assign(count_[0] * count_[1] * count_[2] + 1, 0);
  visit([&](std::int64_t box, std::int32_t) { ++start_[box + 1]; });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  element_.resize(start_.back());
  std::vector<std::int64_t> next(start_.begin(), start_.end() - 1);
  visit([&](std::int64_t box, std::int32_t e) { element_[next[box]++] = e; });
}

PointLocator::Cells PointLocator::box_of(const Vector3& x) const {
  Cells box{};
  for (std::size_t c = 0; c < 3; ++c)
    box[c] = static_cast<std::int64_t>(
        std::clamp((x[c] - low_[c]) * inverse_[c], 0.0, static_cast<double>(count_[c] - 1)));
  return box;
}

std::span<const std::int32_t> PointLocator::nodes(std::int32_t element) const {
  const std::size_t npe = nodes_per_element(mesh_.type);
  return mesh_.connectivity.subspan(static_cast<std::size_t>(element) * npe, npe);
}

PointLocator::Place PointLocator::find(const Vector3& x) const {
  double least = std::numeric_limits<double>::infinity();
  std::optional<Place> best;
  const std::int64_t rings = *std::max_element(count_.begin(), count_.end());
  search_ring(x, {0, true}, least, best);
  for (std::int64_t ring = 0, last = rings; ring <= last && least > rounding; ++ring) {
    const bool had = best.has_value();
    search_ring(x, {ring, false}, least, best);
    if (best && !had) last = std::min(rings, ring + 1);  // the next ring may contain a nearer one
  }
  return best ? *best : Place{};
}

void PointLocator::search_ring(const Vector3& x, const Ring& where, double& least,
                               std::optional<Place>& best) const {
  const auto [ring, only_near] = where;
  const Cell& type = cell(mesh_.type);
  const Cells middle = box_of(x);
  Cells from{}, to{};
  for (std::size_t c = 0; c < 3; ++c) {
    from[c] = std::max<std::int64_t>(0, middle[c] - ring);
    to[c] = std::min(count_[c] - 1, middle[c] + ring);
  }
  for (std::int64_t k = from[2]; k <= to[2]; ++k)
    for (std::int64_t j = from[1]; j <= to[1]; ++j)
      for (std::int64_t i = from[0]; i <= to[0]; ++i) {
        const std::int64_t away =
            std::max({std::abs(k - middle[2]), std::abs(j - middle[1]), std::abs(i - middle[0])});
        if (away != ring) continue;
        const std::int64_t box = (k * count_[1] + j) * count_[0] + i;
        for (std::int64_t m = start_[box]; m < start_[box + 1]; ++m) {
          const auto of = nodes(element_[m]);
          if (only_near && !bounds_[element_[m]].has(x, dimension(mesh_.type))) continue;
          // A point far outside the simplex of the corners is not nearest to the curved element either.
          if (!only_near && type.simplex && outside(type, by_corners(mesh_, of, x)) > 2.0 * least + 1.0)
            continue;
          const std::optional<Vector3> at = reference_point(mesh_, of, x);
          if (!at) continue;
          const double miss = outside(type, *at);
          if (miss < least - rounding) {
            least = miss;
            best = Place{element_[m], *at};
          }
          if (least <= rounding) return;
        }
      }
}

}  // namespace kacanov
