// SPDX-License-Identifier: BSD-3-Clause
// Internal force, stored energy and the elastic diagonal, element by element in long double.
#include "verify/body.hpp"

namespace kacanov::verify {
namespace {

using Tensor = std::array<Vec, 3>;

struct Point {
  Real volume = 0;
  std::vector<Vec> gradient;  ///< of every shape function, in space
};

Point point_at(const Mesh& mesh, const Indices& element, const QuadraturePoint& q) {
  const Functions f = functions(mesh.shape, q.at);
  const auto dim = static_cast<std::size_t>(mesh.dim());
  Tensor along{};  // derivatives of the position
  if (dim == 2) along[2] = {0, 0, 1};
  for (std::size_t a = 0; a < element.size(); ++a)
    for (std::size_t k = 0; k < dim; ++k) along[k] = along[k] + f.gradient[a][k] * mesh.nodes[element[a]];
  const Tensor dual{cross(along[1], along[2]), cross(along[2], along[0]), cross(along[0], along[1])};
  const Real det = dot(along[0], dual[0]);
  Point point{q.weight * det, {}};
  for (const Vec& reference : f.gradient) {
    Vec g{};
    for (std::size_t k = 0; k < dim; ++k) g = g + reference[k] / det * dual[k];
    point.gradient.push_back(g);
  }
  return point;
}

/// Means of the gradients over the element, which the trace is made of with B-bar.
std::vector<Vec> mean_gradients(const std::vector<Point>& points) {
  std::vector<Vec> mean(points[0].gradient.size());
  Real volume = 0;
  for (const Point& point : points) {
    volume += point.volume;
    for (std::size_t a = 0; a < mean.size(); ++a) mean[a] = mean[a] + point.volume * point.gradient[a];
  }
  for (Vec& g : mean) g = 1 / volume * g;
  return mean;
}

Tensor strain(const Indices& element, const Point& point, const std::vector<Vec>& u) {
  Tensor h{};
  for (std::size_t a = 0; a < element.size(); ++a)
    for (std::size_t i = 0; i < 3; ++i) h[i] = h[i] + u[element[a]][i] * point.gradient[a];
  Tensor e{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) e[i][j] = (h[i][j] + h[j][i]) / 2;
  return e;
}

/// Adds what one element does.
void add_element(const Problem& problem, std::size_t e, const std::vector<Vec>& u, BodyResponse& out) {
  const Mesh& mesh = problem.mesh;
  const Indices& element = mesh.elements[e];
  const Law& law = problem.laws[problem.law_of_element[e]];
  const auto dim = static_cast<std::size_t>(mesh.dim());
  std::vector<Point> points;
  for (const QuadraturePoint& q : stiffness_rule(mesh.shape)) points.push_back(point_at(mesh, element, q));
  const std::vector<Vec> mean = mean_gradients(points);
  Real von_mises = 0, volume = 0;
  for (const Point& point : points) {
    const std::vector<Vec>& divergence = law.bbar ? mean : point.gradient;
    Tensor deviator = strain(element, point, u);
    const Real third = (deviator[0][0] + deviator[1][1] + deviator[2][2]) / 3;
    Real square = 0, trace = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      deviator[i][i] -= third;
      square += dot(deviator[i], deviator[i]);
    }
    for (std::size_t a = 0; a < element.size(); ++a) trace += dot(divergence[a], u[element[a]]);
    const Real x = std::sqrt(square), g = law.secant(x), elastic = law.secant(0);
    out.energy += point.volume * (law.bulk * trace * trace / 2 + 2 * law.energy(x));
    Real moved = 0;
    for (std::size_t a = 0; a < element.size(); ++a) moved += norm(point.gradient[a]) * norm(u[element[a]]);
    out.unknown_stress = larger(out.unknown_stress, 1e-15L * 2 * g * moved);
    von_mises += point.volume * std::sqrt(Real(1.5L)) * 2 * g * x;
    volume += point.volume;
    for (std::size_t a = 0; a < element.size(); ++a) {
      const Vec &n = point.gradient[a], &d = divergence[a];
      const auto node = static_cast<std::size_t>(element[a]);
      for (std::size_t i = 0; i < dim; ++i) {
        out.internal[node][i] += point.volume * (law.bulk * trace * d[i] + 2 * g * dot(deviator[i], n));
        out.diagonal[node][i] +=
            point.volume * (law.bulk * d[i] * d[i] + elastic * (n[i] * n[i] / 3 + dot(n, n)));
      }
    }
  }
  out.most_von_mises = larger(out.most_von_mises, von_mises / volume);
}

}  // namespace

BodyResponse respond(const Problem& problem, const std::vector<Vec>& u) {
  const std::size_t nodes = problem.mesh.nodes.size();
  BodyResponse out{std::vector<Vec>(nodes), std::vector<Vec>(nodes), 0, 0, 0};
  for (std::size_t e = 0; e < problem.mesh.elements.size(); ++e) add_element(problem, e, u, out);
  for (std::size_t n = 0; n < problem.springs.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      const Real force = dot(problem.springs[n][c], u[n]);
      out.internal[n][c] += force;
      out.diagonal[n][c] += problem.springs[n][c][c];
      out.energy += force * u[n][c] / 2;
    }
  return out;
}

}  // namespace kacanov::verify
