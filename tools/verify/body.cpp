// SPDX-License-Identifier: BSD-3-Clause
// Computes internal force, stored energy and the elastic diagonal element by element in long double.
#include "verify/body.hpp"

#include <map>
#include <utility>

namespace kacanov::verify {
namespace {

using Tensor = std::array<Vec, 3>;

struct Point {
  Real volume = 0;
  std::vector<Vec> gradient;  ///< spatial gradient of every shape function
  std::vector<Real> hoop;     ///< N/r in axisymmetry, else 0: strain zz per unit u_x

  /// Returns tr ε for unit displacements of a node.
  Vec divergence(std::size_t a) const { return {gradient[a][0] + hoop[a], gradient[a][1], gradient[a][2]}; }
};

Point point_at(const Mesh& mesh, const Indices& element, const QuadraturePoint& q) {
  const Functions f = functions(mesh.shape, q.at);
  const auto dim = static_cast<std::size_t>(mesh.dim());
  Tensor along{};  // derivatives of the position
  if (dim == 2) along[2] = {0, 0, 1};
  for (std::size_t a = 1; a < element.size(); ++a) {
    const Vec side = mesh.nodes[element[a]] - mesh.nodes[element[0]];
    for (std::size_t k = 0; k < dim; ++k) along[k] = along[k] + f.gradient[a][k] * side;
  }
  const Tensor dual{cross(along[1], along[2]), cross(along[2], along[0]), cross(along[0], along[1])};
  const Real det = dot(along[0], dual[0]);
  const Real depth = mesh.depth(element, f);
  Point point{q.weight * det * depth, {}, std::vector<Real>(element.size())};
  for (std::size_t a = 0; a < element.size() && mesh.is_round; ++a)
    point.hoop[a] = 2 * std::acos(Real(-1)) * f.value[a] / depth;
  for (const Vec& reference : f.gradient) {
    Vec g{};
    for (std::size_t k = 0; k < dim; ++k) g = g + reference[k] / det * dual[k];
    point.gradient.push_back(g);
  }
  return point;
}

/// Element means of the divergence, from which B-bar computes the trace.
std::vector<Vec> mean_gradients(const std::vector<Point>& points) {
  std::vector<Vec> mean(points[0].gradient.size());
  Real volume = 0;
  for (const Point& point : points) {
    volume += point.volume;
    for (std::size_t a = 0; a < mean.size(); ++a) mean[a] = mean[a] + point.volume * point.divergence(a);
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
  for (std::size_t a = 0; a < element.size(); ++a) e[2][2] += point.hoop[a] * u[element[a]][0];
  return e;
}

Real trace_of(const Tensor& e) { return e[0][0] + e[1][1] + e[2][2]; }

Tensor deviator_of(Tensor e) {
  const Real third = trace_of(e) / 3;
  for (std::size_t i = 0; i < 3; ++i) e[i][i] -= third;
  return e;
}

Real norm_of(const Tensor& e) { return std::sqrt(dot(e[0], e[0]) + dot(e[1], e[1]) + dot(e[2], e[2])); }

/// Returns the out-of-plane strain with zero stress (theory: plane-stress) by bisection between the elastic
/// value and the one that makes the trace zero.
Real strain_across(const Law& law, Tensor e) {
  const Real plane = e[0][0] + e[1][1], lame = law.bulk - 2 * law.secant(0) / 3;
  Real nearest = -lame / (lame + 2 * law.secant(0)) * plane, farthest = -plane;
  for (int step = 0; step < 90; ++step) {
    e[2][2] = (nearest + farthest) / 2;
    const Tensor deviator = deviator_of(e);
    const Real stress = law.bulk * trace_of(e) + 2 * law.secant(norm_of(deviator)) * deviator[2][2];
    ((stress > 0) == (plane > 0) ? nearest : farthest) = e[2][2];
  }
  return e[2][2];
}

/// Returns the diagonal entry of the elastic stiffness for displacement component i of a node at a point.
Real elastic_entry(const Mesh& mesh, const Law& law, const Point& point, std::size_t a, std::size_t i,
                   Real divergence) {
  const Real mu = law.secant(0), lame = law.bulk - 2 * mu / 3, n = point.gradient[a][i];
  const Real hoop = i == 0 ? point.hoop[a] : 0;
  const Real shears = mu * (dot(point.gradient[a], point.gradient[a]) + n * n + 2 * hoop * hoop);
  if (mesh.is_free_across) return shears + 2 * mu * lame / (lame + 2 * mu) * n * n;
  return shears - 2 * mu / 3 * (n + hoop) * (n + hoop) + law.bulk * divergence * divergence;
}

/// Volumes and volume changes of corners, or of patches of corners, for materials that average them. Keyed by
/// corner or patch and by bulk modulus, because the pressure jumps where the modulus does.
class CornerVolumes {
 public:
  CornerVolumes(const Problem& problem, const std::vector<Vec>& u) : problem_(problem) {
    if (problem.mesh.shape != Shape::tet10 && problem.mesh.shape != Shape::tet4) return;
    for (std::size_t e = 0; e < problem.mesh.elements.size(); ++e) {
      const Indices& element = problem.mesh.elements[e];
      const Law& law = problem.laws[problem.law_of_element[e]];
      if (!law.mixed) continue;
      for (const QuadraturePoint& q : stiffness_rule(problem.mesh.shape)) {
        const Point point = point_at(problem.mesh, element, q);
        for (std::size_t c = 0; c < 4; ++c) {
          At& at = corners_[{place(element[c]), law.bulk}];
          at.volume += share(q, c) * point.volume;
          for (std::size_t a = 0; a < element.size(); ++a)
            at.change += share(q, c) * point.volume * dot(point.divergence(a), u[element[a]]);
        }
      }
    }
  }
  /// Returns whether elements with this law average the volume change.
  bool count(const Law& law) const { return law.mixed && !corners_.empty(); }
  /// Interpolates the means around the element's corners, or their squares, linearly to a point.
  Real mean(const Indices& element, const Law& law, const QuadraturePoint& q, bool squared) const {
    Real sum = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const At& at = corners_.at({place(element[c]), law.bulk});
      const Real mean = at.change / at.volume;
      sum += share(q, c) * (squared ? mean * mean : mean);
    }
    return sum;
  }

 private:
  struct At {
    Real volume = 0, change = 0;
  };
  std::int64_t place(Index node) const {
    return problem_.patch.empty() ? static_cast<std::int64_t>(node) : problem_.patch[node];
  }
  static Real share(const QuadraturePoint& q, std::size_t corner) {
    return corner == 0 ? 1 - q.at[0] - q.at[1] - q.at[2] : q.at[corner - 1];
  }
  const Problem& problem_;
  std::map<std::pair<std::int64_t, Real>, At> corners_;
};

RegionForce& region_at(BodyResponse& out, Index node, std::size_t region) {
  std::vector<RegionForce>& list = out.of_region[node];
  for (RegionForce& one : list)
    if (one.region == region) return one;
  list.push_back({region});
  return list.back();
}

/// Adds the contribution of one element of a region.
void add_element(const Problem& problem, std::size_t e, std::size_t region, const std::vector<Vec>& u,
                 const CornerVolumes& corners, BodyResponse& out) {
  const Mesh& mesh = problem.mesh;
  const Indices& element = mesh.elements[e];
  const Law& law = problem.laws[problem.law_of_element[e]];
  const auto dim = static_cast<std::size_t>(mesh.dim());
  const Real longer = problem.free_strain.empty() ? 0 : problem.free_strain[e];
  const Real warm = longer != 0 ? longer * expansion_stress(law) : 0;  // part of the load
  std::vector<Point> points;
  const auto rule = stiffness_rule(mesh.shape);
  for (const QuadraturePoint& q : rule) points.push_back(point_at(mesh, element, q));
  const bool averaged = corners.count(law);
  const std::vector<Vec> mean = mean_gradients(points);
  Real von_mises = 0, volume = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    std::vector<Vec> divergence = mean;
    for (std::size_t a = 0; a < element.size() && (averaged || !law.bbar); ++a)
      divergence[a] = point.divergence(a);
    Tensor whole = strain(element, point, u);
    whole[0][0] -= longer;
    whole[1][1] -= longer;
    if (mesh.is_free_across) whole[2][2] = strain_across(law, whole);
    const Tensor deviator = deviator_of(whole);
    Real trace = mesh.is_free_across ? whole[2][2] - 2 * longer : 0;
    for (std::size_t a = 0; a < element.size(); ++a) trace += dot(divergence[a], u[element[a]]);
    Real square = trace * trace;
    if (averaged) trace = corners.mean(element, law, rule[k], false);
    if (averaged) square = corners.mean(element, law, rule[k], true);
    const Real x = norm_of(deviator), g = law.secant(x);
    out.energy += point.volume * (law.bulk * square / 2 + 2 * law.energy(x) - warm * longer);
    const Real expansion =
        problem.expansion.empty() || problem.expansion[e].empty() ? 0 : problem.expansion[e][k];
    out.expansion_energy +=
        point.volume * expansion * expansion / (mesh.is_free_across ? expansion_stress(law) : 2 * law.bulk);
    Real moved = 0;
    for (std::size_t a = 0; a < element.size(); ++a)
      moved += (norm(point.gradient[a]) + point.hoop[a]) * norm(u[element[a]]);
    out.unknown_stress = larger(out.unknown_stress, 1e-15L * 2 * g * moved);
    von_mises += point.volume * std::sqrt(Real(1.5L)) * 2 * g * x;
    volume += point.volume;
    for (std::size_t a = 0; a < element.size(); ++a) {
      const Vec &n = point.gradient[a], &d = divergence[a];
      const auto node = static_cast<std::size_t>(element[a]);
      RegionForce& of_region = region_at(out, element[a], region);
      const Real terms = (law.bulk + 2 * g) * moved + std::abs(warm);
      out.size[node] += point.volume * terms * (norm(n) + point.hoop[a]);
      for (std::size_t i = 0; i < dim; ++i) {
        const Real round_axis = i == 0 ? deviator[2][2] * point.hoop[a] : 0;
        const Real force = point.volume * (law.bulk * trace * d[i] +
                                           2 * g * (dot(deviator[i], n) + round_axis) + warm * n[i]);
        const Real expands = point.volume * expansion * point.divergence(a)[i];
        out.internal[node][i] += force;
        out.expansion[node][i] += expands;
        const Real stiffness = point.volume * elastic_entry(mesh, law, point, a, i, d[i]);
        of_region.force[i] += force - expands;
        of_region.diagonal[i] += stiffness;
        out.energy += point.volume * warm * n[i] * u[node][i];
        out.diagonal[node][i] += stiffness;
      }
    }
  }
  out.most_von_mises = larger(out.most_von_mises, von_mises / volume);
  Real largest = 0;
  for (const Index n : element)
    for (std::size_t c = 0; c < dim; ++c) largest = larger(largest, std::abs(u[n][c]));
  for (const Index n : element) {
    RegionForce& of_region = region_at(out, n, region);
    of_region.largest = larger(of_region.largest, largest);
  }
}

}  // namespace

BodyResponse respond(const Problem& problem, const Regions& regions, const std::vector<Vec>& u) {
  const std::size_t nodes = problem.mesh.nodes.size();
  BodyResponse out;
  out.internal.resize(nodes), out.diagonal.resize(nodes), out.expansion.resize(nodes);
  out.of_region.resize(nodes), out.size.resize(nodes);
  const CornerVolumes corners(problem, u);
  for (std::size_t e = 0; e < problem.mesh.elements.size(); ++e)
    add_element(problem, e, regions.of_element[e], u, corners, out);
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
