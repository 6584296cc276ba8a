// SPDX-License-Identifier: BSD-3-Clause
// Shape functions, quadrature rules and facets of the elements (theory: elements, loads).
#include "verify/shape.hpp"

#include <map>
#include <utility>

namespace kacanov::verify {
namespace {

using Corners = std::vector<std::array<int, 3>>;

const Corners& corners(Shape shape) {
  static const Corners line{{-1, 0, 0}, {1, 0, 0}}, quad{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
      hex{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  return shape == Shape::line2 ? line : shape == Shape::quad4 ? quad : hex;
}

/// Ends of the edges of quadratic simplices, in the order of their mid-edge nodes.
using Edges = std::vector<std::pair<int, int>>;
const Edges& edges(Shape shape) {
  static const Edges tri{{0, 1}, {1, 2}, {2, 0}}, tet{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};
  return shape == Shape::tri6 ? tri : tet;
}

bool is_product(Shape shape) {
  return shape == Shape::line2 || shape == Shape::quad4 || shape == Shape::hex8;
}

bool is_quadratic(Shape shape) { return shape == Shape::tri6 || shape == Shape::tet10; }

Functions product_functions(Shape shape, const Vec& at) {
  Functions f;
  const auto dim = static_cast<std::size_t>(dimension(shape));
  for (const auto& corner : corners(shape)) {
    Real value = 1;
    Vec gradient{};
    for (std::size_t k = 0; k < dim; ++k) value *= (1 + corner[k] * at[k]) / 2;
    for (std::size_t k = 0; k < dim; ++k) {
      gradient[k] = Real(corner[k]) / 2;
      for (std::size_t l = 0; l < dim; ++l)
        if (l != k) gradient[k] *= (1 + corner[l] * at[l]) / 2;
    }
    f.value.push_back(value);
    f.gradient.push_back(gradient);
  }
  return f;
}

Functions simplex_functions(Shape shape, const Vec& at) {
  const auto dim = static_cast<std::size_t>(dimension(shape));
  Functions linear;
  linear.value.push_back(1);
  linear.gradient.push_back({});
  for (std::size_t k = 0; k < dim; ++k) {
    Vec unit{};
    unit[k] = 1;
    linear.value[0] -= at[k];
    linear.gradient[0][k] = -1;
    linear.value.push_back(at[k]);
    linear.gradient.push_back(unit);
  }
  if (!is_quadratic(shape)) return linear;
  Functions f;
  for (std::size_t a = 0; a <= dim; ++a) {
    f.value.push_back(linear.value[a] * (2 * linear.value[a] - 1));
    f.gradient.push_back((4 * linear.value[a] - 1) * linear.gradient[a]);
  }
  for (const auto& [a, b] : edges(shape)) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    f.value.push_back(4 * linear.value[i] * linear.value[j]);
    f.gradient.push_back((4 * linear.value[i]) * linear.gradient[j] +
                         (4 * linear.value[j]) * linear.gradient[i]);
  }
  return f;
}

/// Gauss–Legendre rule on [−1, 1] with 2 or 4 points.
std::vector<std::pair<Real, Real>> gauss(int points) {
  if (points == 2) return {{-1 / std::sqrt(Real(3)), 1}, {1 / std::sqrt(Real(3)), 1}};
  const Real root = 2 * std::sqrt(Real(6) / 5) / 7, wide = std::sqrt(Real(3) / 7 + root),
             narrow = std::sqrt(Real(3) / 7 - root), share = std::sqrt(Real(30)) / 36;
  return {{-wide, Real(1) / 2 - share},
          {-narrow, Real(1) / 2 + share},
          {narrow, Real(1) / 2 + share},
          {wide, Real(1) / 2 - share}};
}

std::vector<QuadraturePoint> product_rule(std::size_t dim) {
  std::vector<QuadraturePoint> rule{{{}, 1}};
  for (std::size_t k = 0; k < dim; ++k) {
    std::vector<QuadraturePoint> finer;
    for (const QuadraturePoint& point : rule)
      for (const auto& [x, w] : gauss(2)) {
        finer.push_back({point.at, point.weight * w});
        finer.back().at[k] = x;
      }
    rule = finer;
  }
  return rule;
}

/// Gauss rule with 4 points per direction, collapsed onto the simplex.
std::vector<QuadraturePoint> collapsed_rule(int dim) {
  std::vector<QuadraturePoint> rule;
  for (const auto& [a, wa] : gauss(4))
    for (const auto& [b, wb] : gauss(4)) {
      const Real u = (1 + a) / 2, v = (1 + b) / 2;
      if (dim == 2) {
        rule.push_back({{u, v * (1 - u), 0}, wa * wb * (1 - u) / 4});
        continue;
      }
      for (const auto& [c, wc] : gauss(4)) {
        const Real w = (1 + c) / 2;
        rule.push_back(
            {{u, v * (1 - u), w * (1 - u) * (1 - v)}, wa * wb * wc * (1 - u) * (1 - u) * (1 - v) / 8});
      }
    }
  return rule;
}

/// One-point rule, exact for linear functions.
std::vector<QuadraturePoint> mean_rule(int dim) {
  if (dim == 2) return {{{Real(1) / 3, Real(1) / 3, 0}, Real(1) / 2}};
  return {{{Real(1) / 4, Real(1) / 4, Real(1) / 4}, Real(1) / 6}};
}

}  // namespace

int dimension(Shape shape) {
  if (shape == Shape::line2) return 1;
  return shape == Shape::tet4 || shape == Shape::tet10 || shape == Shape::hex8 ? 3 : 2;
}

int node_count(Shape shape) {
  static const std::map<Shape, int> counts{{Shape::line2, 2}, {Shape::tri3, 3}, {Shape::tri6, 6},
                                           {Shape::quad4, 4}, {Shape::tet4, 4}, {Shape::tet10, 10},
                                           {Shape::hex8, 8}};
  return counts.at(shape);
}

int corner_count(Shape shape) { return is_quadratic(shape) ? dimension(shape) + 1 : node_count(shape); }

Functions functions(Shape shape, const Vec& at) {
  return is_product(shape) ? product_functions(shape, at) : simplex_functions(shape, at);
}

std::vector<QuadraturePoint> stiffness_rule(Shape shape) {
  if (is_product(shape)) return product_rule(dimension(shape));
  if (shape != Shape::tet10) return mean_rule(dimension(shape));
  const Real far = (5 - std::sqrt(Real(5))) / 20, near = (5 + 3 * std::sqrt(Real(5))) / 20, w = Real(1) / 24;
  return {{{far, far, far}, w}, {{near, far, far}, w}, {{far, near, far}, w}, {{far, far, near}, w}};
}

std::vector<QuadraturePoint> load_rule(Shape shape, bool finer) {
  if (is_product(shape)) return product_rule(dimension(shape));
  return is_quadratic(shape) || finer ? collapsed_rule(dimension(shape)) : mean_rule(dimension(shape));
}

Shape corner_shape(Shape shape) {
  return shape == Shape::tet10 ? Shape::tet4 : shape == Shape::tri6 ? Shape::tri3 : shape;
}

Shape facet_shape(Shape body) {
  switch (body) {
    case Shape::tet4: return Shape::tri3;
    case Shape::tet10: return Shape::tri6;
    case Shape::hex8: return Shape::quad4;
    default: return Shape::line2;
  }
}

std::vector<std::vector<int>> facets(Shape body) {
  switch (body) {
    case Shape::tri3: return {{0, 1}, {1, 2}, {2, 0}};
    case Shape::quad4: return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case Shape::hex8:
      return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    default: break;
  }
  std::vector<std::vector<int>> all{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  if (body == Shape::tet4) return all;
  for (auto& facet : all)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = facet[k], b = facet[(k + 1) % 3];
      int middle = corner_count(body);
      for (const auto& [i, j] : edges(body)) {
        if ((i == a && j == b) || (i == b && j == a)) break;
        ++middle;
      }
      facet.push_back(middle);
    }
  return all;
}

}  // namespace kacanov::verify
