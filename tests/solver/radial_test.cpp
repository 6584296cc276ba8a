// SPDX-License-Identifier: BSD-3-Clause
// Thick cylinders and spheres under pressure, against the radial ordinary differential equation.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <kacanov/law.hpp>
#include "support.hpp"

using namespace kacanov::testing;
using namespace kacanov;

namespace kacanov::testing {

/// Solves τ_r' + m (τ_r − τ_θ)/r = 0 on [a, b] with ε_r = u', ε_θ = u/r, τ_r(a) = −p, τ_r(b) = 0; m = 1 for
/// the cylinder in plane strain, 2 for the sphere. The state is (u, τ_r); u' follows from τ_r, which is
/// monotone in u'.
class RadialSolution {
 public:
  RadialSolution(const Law& law, int m, double a, double b, double pressure, int steps = 2000)
      : law_(law), m_(m), a_(a), step_((b - a) / steps), u_(static_cast<std::size_t>(steps) + 1) {
    // τ_r(b) is monotone in u(a): bisection.
    double low = 0.0, high = 1e-6 * a;
    while (shoot(high, pressure) < 0.0) high *= 2.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (shoot(middle, pressure) < 0.0 ? low : high) = middle;
    }
    shoot(high, pressure);
  }

  /// Returns the radial displacement at r.
  double operator()(double r) const {
    const double at = std::clamp((r - a_) / step_, 0.0, static_cast<double>(u_.size()) - 1.000001);
    const auto i = static_cast<std::size_t>(at);
    const double t = at - static_cast<double>(i);
    return (1 - t) * u_[i] + t * u_[i + 1];
  }
  double largest_dev_strain() const { return largest_; }

 private:
  struct Strain {
    double radial, hoop;
  };
  struct Stress {
    double radial, hoop, dev_strain;
  };
  Stress stress(const Strain& e) const {
    const double third = (e.radial + m_ * e.hoop) / 3.0;
    const double dr = e.radial - third, dt = e.hoop - third, dz = -third;
    // The third strain is 0 in plane strain, and a second hoop strain on the sphere.
    const double x = std::sqrt(dr * dr + dt * dt + (m_ == 1 ? dz * dz : dt * dt));
    const double g = law_.secant(x), mean = 3.0 * law_.bulk * third;
    return {mean + 2 * g * dr, mean + 2 * g * dt, x};
  }
  double radial_strain(double hoop, double tau) const {
    double high = 1.0 + 3.0 * std::abs(hoop), low = -high;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (stress({middle, hoop}).radial < tau ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  struct State {
    double u, tau;
  };
  State slope(double r, const State& s) const {
    const double du = radial_strain(s.u / r, s.tau);
    return {du, -m_ * (s.tau - stress({du, s.u / r}).hoop) / r};
  }
  /// Returns τ_r(b) for a given u(a), by Runge's midpoint rule; fills u_.
  double shoot(double u_inner, double pressure) {
    State s{u_inner, -pressure};
    u_[0] = u_inner;
    largest_ = stress({radial_strain(u_inner / a_, -pressure), u_inner / a_}).dev_strain;
    for (std::size_t i = 1; i < u_.size(); ++i) {
      const double r = a_ + step_ * static_cast<double>(i - 1);
      const State first = slope(r, s);
      const State middle =
          slope(r + 0.5 * step_, {s.u + 0.5 * step_ * first.u, s.tau + 0.5 * step_ * first.tau});
      s = {s.u + step_ * middle.u, s.tau + step_ * middle.tau};
      u_[i] = s.u;
    }
    return s.tau;
  }

  Law law_;
  int m_;
  double a_, step_, largest_ = 0.0;
  std::vector<double> u_;
};

}  // namespace kacanov::testing

namespace {

constexpr double inner = 1.0, outer = 2.0;

/// Makes a group of the facets all of whose nodes satisfy a condition.
void name_facets(Mesh& mesh, const std::string& name, const std::function<bool(const Vector3&)>& here) {
  const std::size_t dim = mesh.dim();
  Group group{name, mesh.dim() - 1, {}};
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const auto nodes = mesh.facet(f);
    if (std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t n) {
          const double* x = &mesh.coordinates[static_cast<std::size_t>(n) * dim];
          return here({x[0], x[1], dim == 3 ? x[2] : 0.0});
        }))
      group.members.push_back(static_cast<std::int32_t>(f));
  }
  mesh.groups.push_back(group);
}

/// A quarter of a thick cylinder or an octant of a thick sphere: the shell of cubes with ½ ≤ max x ≤ 1 mapped
/// to a round one, n cells through the wall.
Mesh round_shell(int dim, int n) {
  BoxSpec spec;
  spec.cells = {2 * n, 2 * n, 2 * n};
  spec.type = dim == 2 ? ElementType::tri3 : ElementType::tet4;
  const Mesh cube = make_box(spec);
  const std::size_t d = dim;
  const std::size_t npe = nodes_per_element(cube.type);
  Mesh mesh;
  mesh.type = cube.type;
  std::map<std::int32_t, std::int32_t> kept;
  for (std::size_t e = 0; e < cube.element_count(); ++e) {
    const auto nodes = std::span(cube.elements).subspan(e * npe, npe);
    double mean = 0.0;  // mean of the largest coordinate: below ½ only inside the hole
    for (const auto node : nodes) {
      const double* x = &cube.coordinates[static_cast<std::size_t>(node) * d];
      mean += *std::max_element(x, x + d) / static_cast<double>(npe);
    }
    if (mean < 0.5) continue;
    for (const auto node : nodes) {
      const auto [place, fresh] = kept.try_emplace(node, static_cast<std::int32_t>(kept.size()));
      mesh.elements.push_back(place->second);
      if (!fresh) continue;
      const double* x = &cube.coordinates[static_cast<std::size_t>(node) * d];
      mesh.coordinates.insert(mesh.coordinates.end(), x, x + d);
    }
  }
  map_nodes(mesh, [&](Vector3 x) {
    const double level = std::max({x[0], x[1], x[2]}), r = inner + (outer - inner) * (2 * level - 1);
    for (double& v : x) v = std::tan(0.25 * M_PI * v / level);  // uniform angles
    const double size = length(x);
    return Vector3{r * x[0] / size, r * x[1] / size, r * x[2] / size};
  });
  find_boundary(mesh);
  check_mesh(mesh);
  name_facets(mesh, "inside", [](const Vector3& x) { return std::abs(length(x) - inner) < 1e-9; });
  for (std::size_t c = 0; c < d; ++c)
    name_facets(mesh, std::string("plane") + "xyz"[c],
                [c](const Vector3& x) { return std::abs(x[c]) < 1e-9; });
  return mesh;
}

/// Returns the relative L² error of the displacement, by the edge-midpoint (2D) or four-point (3D) rule.
double displacement_error(const Run& run, const RadialSolution& exact) {
  const Part& part = run.part;
  const auto dim = static_cast<std::size_t>(part.dim()), npe = dim + 1;
  std::vector<double> volume(part.element_count());
  reference::volumes(part.body(), volume);
  const double far = dim == 2 ? 0.5 : 0.1381966011250105, near = dim == 2 ? 0.0 : 0.5854101966249685;
  double error = 0.0, size = 0.0;
  for (std::size_t e = 0; e < volume.size(); ++e)
    for (std::size_t q = 0; q < npe; ++q) {
      Vector3 x{}, u{};
      for (std::size_t a = 0; a < npe; ++a) {
        const std::size_t node = part.elements[e * npe + a];
        for (std::size_t c = 0; c < dim; ++c) {
          x[c] += (a == q ? near : far) * part.coordinates[node * dim + c];
          u[c] += (a == q ? near : far) * run.solution.displacement[node * dim + c];
        }
      }
      const double r = length(x), radial = exact(r);
      const double weight = volume[e] / static_cast<double>(npe);
      error += weight * std::pow(distance(u, {radial * x[0] / r, radial * x[1] / r, radial * x[2] / r}), 2);
      size += weight * radial * radial;
    }
  return std::sqrt(error / size);
}

using Formulation = MaterialEntry::Formulation;

Model shell_model(int dim, const Law& law, Formulation formulation, double pressure_inside) {
  Model model;
  model.materials.push_back({everything(), law});
  if (formulation == Formulation::mixed) model.materials[0].formulation = formulation;
  for (int c = 0; c < dim; ++c) model.boundary.push_back(roller(named(std::string("plane") + "xyz"[c]), c));
  model.boundary.push_back(pressure(named("inside"), pressure_inside));
  model.solver.tolerance = 1e-8;
  return model;
}

void check_order(int dim, const std::vector<int>& cells, double pressure_inside, double finest_error,
                 PlaneState plane = PlaneState::strain, Formulation formulation = Formulation::displacement) {
  CAPTURE(dim);
  for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.01)}) {
    // A quarter of a disc, rotated about an axis, is half a sphere.
    const int m = plane == PlaneState::axisymmetric ? 2 : dim - 1;
    const RadialSolution exact(law, m, inner, outer, pressure_inside, 500);
    if (!law.linear()) CHECK(exact.largest_dev_strain() > 3 * law.yield_strain());
    std::vector<double> errors;
    for (const int n : cells) {
      Model model = shell_model(dim, law, formulation, pressure_inside);
      model.plane = plane;
      const Run run = run_alone(round_shell(dim, n), model);
      CHECK(run.result().status == Status::converged);
      errors.push_back(displacement_error(run, exact));
    }
    const std::size_t last = errors.size() - 1;
    CAPTURE(errors[last - 1]);
    CAPTURE(errors[last]);
    CHECK(std::log2(errors[last - 1] / errors[last]) > 1.7);
    CHECK(errors[last] < finest_error);
  }
}

}  // namespace

TEST_CASE("the radial solution: Lamé's formulas and the incompressible limit") {
  const Law linear = elastic_law(1.0, 0.3);
  const double lame = linear.bulk - 2.0 / 3.0 * linear.shear, p = 0.01;
  // u = A r + C / r^m with τ_r(a) = −p, τ_r(b) = 0.
  for (const int m : {1, 2}) {
    const double ratio = std::pow(inner / outer, m + 1),
                 c = p * std::pow(inner, m + 1) / (2 * linear.shear * m * (1 - ratio));
    const double a = p * ratio / ((1 - ratio) * ((m + 1) * lame + 2 * linear.shear));
    const RadialSolution exact(linear, m, inner, outer, p);
    for (const double r : {inner, 1.3, outer})
      CHECK(exact(r) == doctest::Approx(a * r + c / std::pow(r, m)).epsilon(1e-6));
  }
  // Nearly incompressible: u = C/r^m and p = factor [H(x_a) − H(x_b)], H(x) = ∫ g ds.
  const Law law = logarithmic_law(0.01, 1.0, 0.49999);
  const auto h = [&](double x) {
    const double x0 = law.yield_strain();
    if (x <= x0) return law.shear * x;
    const double l = std::log(x / x0);
    return law.shear * x0 * (1 + l + 0.5 * l * l);
  };
  for (const int m : {1, 2}) {
    const double strain = m == 1 ? std::sqrt(2.0) : std::sqrt(6.0),
                 factor = m == 1 ? std::sqrt(2.0) : 4 / std::sqrt(6.0);
    const double c = 0.03;
    const double load = factor * (h(strain * c) - h(strain * c / std::pow(outer, m + 1)));
    const RadialSolution exact(law, m, inner, outer, load);
    CHECK(exact(inner) == doctest::Approx(c).epsilon(2e-3));
    CHECK(exact(outer) == doctest::Approx(c / std::pow(outer, m)).epsilon(2e-3));
  }
}

TEST_CASE("thick cylinder under pressure: second order against the radial equation") {
  check_order(2, {16, 32}, 0.02, 3e-3);
}

TEST_CASE("thick sphere under pressure: second order against the radial equation") {
  check_order(3, {5, 10}, 0.02, 3e-2);
}

TEST_CASE("thick sphere of mixed tet4 under pressure: second order against the radial equation") {
  check_order(3, {5, 10}, 0.02, 3e-2, PlaneState::strain, Formulation::mixed);
}

TEST_CASE("thick sphere far beyond yield: mixed tet4 bears the exact pressure, plain tet4 much more") {
  constexpr double x0 = 1e-3;
  const Law law = logarithmic_law(x0);
  const auto bore = [&](double load) { return RadialSolution(law, 2, inner, outer, load, 200)(inner); };
  // The pressure whose exact solution opens the bore by u.
  const auto pressure_for = [&](double u) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 24; ++i) (bore(0.5 * (low + high)) < u ? low : high) = 0.5 * (low + high);
    return high;
  };
  for (const double strain : {10.0, 1e3, 1e4}) {
    CAPTURE(strain);
    const double load = pressure_for(strain * x0 / std::sqrt(6.0) * inner);
    for (const Formulation formulation : {Formulation::displacement, Formulation::mixed}) {
      const Run run = run_alone(round_shell(3, 5), shell_model(3, law, formulation, load));
      CHECK(run.result().status == Status::converged);
      double u = 0.0, count = 0.0;
      for (std::size_t n = 0; n < run.part.nodes(); ++n) {
        const double* x = &run.part.coordinates[3 * n];
        if (std::abs(std::hypot(x[0], x[1], x[2]) - inner) > 1e-9) continue;
        const double* moved = &run.solution.displacement[3 * n];
        u += std::hypot(moved[0], moved[1], moved[2]), count += 1.0;
      }
      const double over = load / pressure_for(u / count);
      CAPTURE(over);
      if (formulation == Formulation::mixed)
        CHECK(over == doctest::Approx(1.0).epsilon(0.005));
      else
        CHECK(over > (strain > 100.0 ? 1.3 : 1.07));
    }
  }
}

TEST_CASE("thick sphere as a section that goes round an axis: second order against the radial equation") {
  check_order(2, {16, 32}, 0.02, 3e-3, PlaneState::axisymmetric);
}

TEST_CASE("thick cylinder as a section that goes round its axis: second order against the radial equation") {
  for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.01)}) {
    const RadialSolution exact(law, 1, inner, outer, 0.02, 500);
    for (const ElementType type : {ElementType::tri3, ElementType::quad4}) {
      std::vector<double> errors;
      for (const int n : {16, 32}) {
        Mesh mesh = make_box({{outer - inner, 0.25, 0}, {n, n / 4, 1}, type});
        map_nodes(mesh, [](const Vector3& x) { return Vector3{x[0] + inner, x[1], 0}; });
        Model model;
        model.plane = PlaneState::axisymmetric;
        model.materials.push_back({everything(), law});
        model.boundary = {roller(named("bottom"), 1), roller(named("top"), 1), pressure(named("left"), 0.02)};
        model.solver.tolerance = 1e-8;
        const Run run = run_alone(mesh, model);
        CHECK(run.result().status == Status::converged);
        double error = 0.0, size = 0.0;
        for (std::size_t k = 0; k < run.part.nodes(); ++k) {
          const double radial = exact(run.part.coordinates[2 * k]);
          error += std::pow(run.solution.displacement[2 * k] - radial, 2);
          size += radial * radial;
        }
        errors.push_back(std::sqrt(error / size));
      }
      CAPTURE(errors[0]);
      CAPTURE(errors[1]);
      CHECK(errors[1] < 2e-3);
      CHECK(std::log2(errors[0] / errors[1]) > 1.7);
    }
  }
}
