// SPDX-License-Identifier: BSD-3-Clause
// Extracts boundary triangles and outlines, and projects them.
#include "pictures/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kacanov {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector unit(const Vector& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Vector{a[0] / length, a[1] / length, a[2] / length} : a;
}

/// Surface triangle by node numbers; bit k of `edges` as in Face.
struct Triangle {
  std::array<std::int32_t, 3> nodes{};
  std::uint8_t edges = 0;
};

/// Returns the triangles of one face cell; `edges` marks the sides that are element edges.
std::vector<Triangle> triangles_of(const Cell& flat) {
  std::vector<Triangle> result;
  for (const auto& corners : flat.triangles) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.nodes[k] = corners[k];
      const auto on = [&](const CellEdge& e, std::int8_t node) {
        return node == e.a || node == e.b || node == e.middle;
      };
      for (const CellEdge& edge : flat.edges)
        if (on(edge, corners[k]) && on(edge, corners[(k + 1) % 3]))
          triangle.edges = static_cast<std::uint8_t>(triangle.edges | 1 << k);
    }
    result.push_back(triangle);
  }
  return result;
}

/// Returns the triangles to draw: all in 2D, those of the boundary in 3D.
std::vector<Triangle> triangles(const Mesh& mesh) {
  const bool whole = mesh.dim() == 2;
  const Cell& flat = whole ? cell(mesh.type) : cell(mesh.type).facet();
  const std::vector<Triangle> pattern = triangles_of(flat);
  const std::vector<std::int32_t>& nodes = whole ? mesh.elements : mesh.facets;
  std::vector<Triangle> result;
  result.reserve(nodes.size() / static_cast<std::size_t>(flat.nodes) * pattern.size());
  for (std::size_t first = 0; first < nodes.size(); first += static_cast<std::size_t>(flat.nodes))
    for (Triangle triangle : pattern) {
      for (std::int32_t& node : triangle.nodes) node = nodes[first + static_cast<std::size_t>(node)];
      result.push_back(triangle);
    }
  return result;
}

/// Projected node positions, and triangle normals in the projection.
class Shape {
 public:
  Shape(const Mesh& mesh, const View& view, std::span<const double> displacement, double scale) {
    const std::size_t dim = mesh.dim();
    points_.resize(mesh.node_count());
    Vector at{};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t k = 0; k < dim; ++k)
        at[k] = mesh.coordinates[i * dim + k] + scale * displacement[i * dim + k];
      points_[i] = view.project(std::span(at).first(dim));
    }
  }
  const Vector& at(std::int32_t node) const { return points_[node]; }
  Vector normal(const Triangle& t) const {
    return unit(cross(minus(at(t.nodes[1]), at(t.nodes[0])), minus(at(t.nodes[2]), at(t.nodes[0]))));
  }

 private:
  std::vector<Vector> points_;
};

/// A side of a drawn triangle, to be matched with the same side of a neighbour.
struct Side {
  std::int32_t low, high;
  std::uint32_t triangle;
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t].nodes[k], triangles[t].nodes[(k + 1) % 3]);
      sides.push_back({low, high, t});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return sides;
}

/// Outline: sides with one triangle only, sides between a visible and a hidden triangle, and visible sharp
/// edges.
std::vector<Segment> outline(const std::vector<Triangle>& triangles, const std::vector<Side>& sides,
                             const Shape& shape) {
  constexpr double sharp = 0.77;  // cosine of 40°
  std::vector<Segment> result;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    bool drawn = end - i != 2;
    if (!drawn) {
      const Vector a = shape.normal(triangles[sides[i].triangle]);
      const Vector b = shape.normal(triangles[sides[i + 1].triangle]);
      const bool a_seen = a[2] > 0, b_seen = b[2] > 0;
      drawn = a_seen != b_seen || (a_seen && dot(a, b) < sharp);
    }
    if (drawn) result.push_back({shape.at(sides[i].low), shape.at(sides[i].high)});
    i = end;
  }
  return result;
}

std::uint8_t shade_of(const Vector& normal) {
  static const Vector light = unit({-0.35, 0.55, 0.76});
  const double brightness = std::max(0.0, dot(normal, light));
  return static_cast<std::uint8_t>(std::min(shades - 1, static_cast<int>(brightness * shades)));
}

}  // namespace

View View::of(const Mesh& mesh, const std::array<double, 3>& towards) {
  View view;
  if (mesh.dim() == 2) return view;
  const auto look_from = [&view](const Vector& from) {
    view.eye = unit(from);
    const Vector across = cross({0, 0, 1}, view.eye);
    view.right = dot(across, across) > 1e-12 ? unit(across) : Vector{1, 0, 0};
    view.up = cross(view.eye, view.right);
    return view;
  };
  if (dot(towards, towards) > 0) return look_from(towards);
  Vector low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = std::numeric_limits<double>::infinity();
    high[k] = -low[k];
    for (std::size_t i = k; i < mesh.coordinates.size(); i += 3) {
      low[k] = std::min(low[k], mesh.coordinates[i]);
      high[k] = std::max(high[k], mesh.coordinates[i]);
    }
  }
  // The eye is 30° off the normal of the longer side and 25° above the horizontal.
  constexpr double s = 0.5, c = 0.8660254037844386, below = 0.42261826174069944, level = 0.9063077870366499;
  if (high[0] - low[0] >= high[1] - low[1]) return look_from({level * s, -level * c, below});
  return look_from({level * c, level * s, below});
}

std::array<double, 3> View::project(std::span<const double> position) const {
  Vector result{};
  for (std::size_t k = 0; k < position.size(); ++k) {
    result[0] += right[k] * position[k];
    result[1] += up[k] * position[k];
    result[2] += eye[k] * position[k];
  }
  return result;
}

std::vector<std::array<std::int32_t, 3>> surface_triangles(const Mesh& mesh) {
  std::vector<std::array<std::int32_t, 3>> result;
  for (const Triangle& triangle : triangles(mesh)) result.push_back(triangle.nodes);
  return result;
}

VisibleSurface visible_surface(const Mesh& mesh, const View& view, std::span<const double> displacement,
                               double scale, std::span<const double> values) {
  const std::vector<Triangle> all = triangles(mesh);
  const std::vector<Side> sides = sorted_sides(all);
  VisibleSurface surface;
  {
    const Shape undeformed(mesh, view, displacement, 0);
    surface.original = outline(all, sides, undeformed);
  }
  const Shape shape(mesh, view, displacement, scale);
  surface.outline = outline(all, sides, shape);
  for (const Triangle& t : all) {
    const Vector normal = shape.normal(t);
    if (mesh.dim() == 3 && normal[2] <= 0) continue;
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      face.corners[k] = shape.at(t.nodes[k]);
      face.values[k] = values[t.nodes[k]];
    }
    face.shade = mesh.dim() == 3 ? shade_of(normal) : shades - 1;
    face.edges = t.edges;
    surface.faces.push_back(face);
  }
  return surface;
}

}  // namespace kacanov
