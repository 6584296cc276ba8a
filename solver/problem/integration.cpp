// SPDX-License-Identifier: BSD-3-Clause
// Integrals of shape functions over facets and elements, for loads and contact mass.
#include "problem/integration.hpp"

#include <numbers>
#include <span>
#include <vector>

#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

struct Point {
  Vector3 at;
  double weight;
};

// Gauss–Legendre on [−1, 1].
constexpr std::array<std::array<double, 2>, 2> gauss2{
    {{-0.57735026918962576451, 1.0}, {0.57735026918962576451, 1.0}}};
constexpr std::array<std::array<double, 2>, 4> gauss4{{{-0.86113631159405257522, 0.34785484513745385737},
                                                       {-0.33998104358485626480, 0.65214515486254614263},
                                                       {0.33998104358485626480, 0.65214515486254614263},
                                                       {0.86113631159405257522, 0.34785484513745385737}}};

/// Tensor product of two-point Gauss rules on a line, square or cube: degree 3 in each direction.
std::vector<Point> tensor_rule(int dim) {
  std::vector<Point> rule{{{0.0, 0.0, 0.0}, 1.0}};
  for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c) {
    std::vector<Point> finer;
    for (const Point& point : rule) {
      for (const auto& [x, w] : gauss2) {
        finer.push_back(point);
        finer.back().at[c] = x;
        finer.back().weight *= w;
      }
    }
    rule = finer;
  }
  return rule;
}

/// Four-point Gauss rules of the cube collapsed onto the unit simplex: degree 5 in 3D, 6 in 2D.
std::vector<Point> simplex_rule(int dim) {
  std::vector<Point> rule;
  for (const auto& [gu, wu] : gauss4) {
    for (const auto& [gv, wv] : gauss4) {
      const double u = 0.5 * (1.0 + gu), v = 0.5 * (1.0 + gv);
      if (dim == 2) {
        rule.push_back({{u, v * (1.0 - u), 0.0}, 0.25 * wu * wv * (1.0 - u)});
        continue;
      }
      for (const auto& [gw, ww] : gauss4) {
        const double w = 0.5 * (1.0 + gw);
        rule.push_back({{u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v)},
                        0.125 * wu * wv * ww * (1.0 - u) * (1.0 - u) * (1.0 - v)});
      }
    }
  }
  return rule;
}

/// Returns a rule that is exact for loads of constant density on cells with flat faces. One point suffices
/// for linear simplices, where the centroid value replaces any rule.
const std::vector<Point>& rule_for(const Cell& cell, PlaneState plane) {
  static const std::vector<Point> tensor[] = {tensor_rule(1), tensor_rule(2), tensor_rule(3)};
  static const std::vector<Point> simplex[] = {simplex_rule(2), simplex_rule(3)};
  static const std::vector<Point> mean[] = {{{{1.0 / 3.0, 1.0 / 3.0, 0.0}, 0.5}},
                                            {{{0.25, 0.25, 0.25}, 1.0 / 6.0}}};
  const std::size_t dim = cell.dim;
  if (!cell.simplex) return tensor[dim - 1];
  return cell.order == 1 && plane != PlaneState::axisymmetric ? mean[dim - 2] : simplex[dim - 2];
}

/// Returns the length of the circle that a section point represents in axisymmetric bodies, else 1 (theory:
/// axisymmetry).
double circle(const Mesh& mesh, std::span<const std::int32_t> nodes, const Shapes& shapes) {
  if (mesh.plane != PlaneState::axisymmetric) return 1.0;
  double r = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k) r += shapes.value[k] * position(mesh, nodes[k])[0];
  return 2.0 * std::numbers::pi * r;
}

/// Outer normal times area of a flat triangle.
Vector3 area_vector(const Vector3& a, const Vector3& b, const Vector3& c) {
  return 0.5 * cross(b - a, c - a);
}

/// Outer normal of a facet times the area ratio to the reference cell, at a point with these shape functions.
Vector3 normal_at(const Mesh& mesh, std::span<const std::int32_t> nodes, const Shapes& shapes) {
  Vector3 along{}, across{};
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const Vector3 side = position(mesh, nodes[k]) - position(mesh, nodes[0]);
    along = along + shapes.gradient[k][0] * side;
    across = across + shapes.gradient[k][1] * side;
  }
  // In 2D the body lies to the left of the edge.
  return mesh.dim() == 2 ? Vector3{along[1], -along[0], 0.0} : cross(along, across);
}

/// Derivatives of the position with respect to the reference coordinates; 1 across the plane.
std::array<Vector3, 3> jacobian_at(const Mesh& mesh, std::span<const std::int32_t> nodes,
                                   const Shapes& shapes) {
  std::array<Vector3, 3> jacobian{};
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const Vector3 side = position(mesh, nodes[k]) - position(mesh, nodes[0]);
    for (std::size_t c = 0; c < 3; ++c) jacobian[c] = jacobian[c] + shapes.gradient[k][c] * side;
  }
  if (mesh.dim() == 2) jacobian[2] = {0.0, 0.0, 1.0};
  return jacobian;
}

double linear_between(const Cell& type, std::span<const double> at_corners, const Vector3& at) {
  std::array<double, most_nodes> shape{};
  corner_cell(type).values(at.data(), shape.data());
  double sum = 0.0;
  for (std::size_t k = 0; k < at_corners.size(); ++k) sum += shape[k] * at_corners[k];
  return sum;
}

}  // namespace

FacetWeights consistent_weights(const Mesh& mesh, std::size_t facet) {
  FacetWeights weights;
  const auto nodes = mesh.facet(facet);
  const Cell& type = cell(mesh.type).facet();
  if (type.simplex && type.order == 1) {  // by far the most frequent type, and constant
    const Vector3 third = (1.0 / 3.0) * area_vector(position(mesh, nodes[0]), position(mesh, nodes[1]),
                                                    position(mesh, nodes[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      weights.normal[k] = third;
      weights.area[k] = norm(third);
    }
    return weights;
  }
  for (const Point& point : rule_for(type, mesh.plane)) {
    const Shapes shapes = shapes_at(type, point.at);
    const Vector3 normal = circle(mesh, nodes, shapes) * normal_at(mesh, nodes, shapes);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      weights.normal[k] = weights.normal[k] + point.weight * shapes.value[k] * normal;
      weights.area[k] += point.weight * shapes.value[k] * norm(normal);
    }
  }
  return weights;
}

FacetWeights lumped_weights(const Mesh& mesh, std::size_t facet) {
  const Cell& type = cell(mesh.type).facet();
  if (type.order == 1) return consistent_weights(mesh, facet);
  // Mid-side rule, exact for quadratic functions: each node gets its weight in a uniform load.
  FacetWeights weights;
  const auto nodes = mesh.facet(facet);
  for (const CellEdge& edge : type.edges) {
    const std::size_t k = edge.middle;
    weights.normal[k] = 1.0 / 6.0 * normal_at(mesh, nodes, shapes_at(type, type.reference[k]));
    weights.area[k] = norm(weights.normal[k]);
  }
  return weights;
}

std::array<double, most_nodes> volume_weights(const Mesh& mesh, std::size_t element) {
  const Cell& type = cell(mesh.type);
  std::array<double, most_nodes> weights{};
  const std::size_t n = type.nodes;
  const auto nodes = std::span(mesh.elements).subspan(element * n, n);
  for (const Point& point : rule_for(type, mesh.plane)) {
    const Shapes shapes = shapes_at(type, point.at);
    const std::array<Vector3, 3> jacobian = jacobian_at(mesh, nodes, shapes);
    const double volume =
        circle(mesh, nodes, shapes) * point.weight * dot(jacobian[0], cross(jacobian[1], jacobian[2]));
    for (std::size_t k = 0; k < n; ++k) weights[k] += volume * shapes.value[k];
  }
  return weights;
}

std::array<Vector3, most_nodes> gradient_weights(const Mesh& mesh, std::size_t element,
                                                 std::span<const double> at_corners) {
  const Cell& type = cell(mesh.type);
  std::array<Vector3, most_nodes> weights{};
  const std::size_t n = type.nodes;
  const auto nodes = std::span(mesh.elements).subspan(element * n, n);
  for (const auto& at : type.points) {
    const Shapes shapes = shapes_at(type, at);
    const std::array<Vector3, 3> jacobian = jacobian_at(mesh, nodes, shapes);
    const double each = type.weight * (at_corners.empty() ? 1.0 : linear_between(type, at_corners, at));
    // Spatial gradients times the determinant.
    const std::array<Vector3, 3> dual{cross(jacobian[1], jacobian[2]), cross(jacobian[2], jacobian[0]),
                                      cross(jacobian[0], jacobian[1])};
    const double weight = circle(mesh, nodes, shapes) * each;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t c = 0; c < static_cast<std::size_t>(type.dim); ++c)
        weights[k] = weights[k] + weight * shapes.gradient[k][c] * dual[c];
    if (mesh.plane != PlaneState::axisymmetric) continue;
    // Contribution of the hoop strain: N/r over the volume.
    const double area = 2.0 * std::numbers::pi * each * dot(jacobian[0], dual[0]);
    for (std::size_t k = 0; k < n; ++k) weights[k][0] += area * shapes.value[k];
  }
  return weights;
}

double mean_by_points(const Mesh& mesh, std::size_t element, std::span<const double> at_corners) {
  const Cell& type = cell(mesh.type);
  const std::size_t n = type.nodes;
  const auto nodes = std::span(mesh.elements).subspan(element * n, n);
  double sum = 0.0, whole = 0.0;
  for (const auto& at : type.points) {
    const Shapes shapes = shapes_at(type, at);
    const std::array<Vector3, 3> jacobian = jacobian_at(mesh, nodes, shapes);
    const double volume = circle(mesh, nodes, shapes) * dot(jacobian[0], cross(jacobian[1], jacobian[2]));
    sum += volume * linear_between(type, at_corners, at);
    whole += volume;
  }
  return sum / whole;
}

}  // namespace kacanov
