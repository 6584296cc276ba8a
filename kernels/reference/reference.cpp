// SPDX-License-Identifier: BSD-3-Clause
// The operator as one plain loop an element, the same for every element type.
#include <kacanov/reference.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cells/dispatch.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"
#include "reference/point_strain.hpp"

namespace kacanov::reference {
namespace {

using elements::Nodal;
using elements::Point;
using elements::points_of;

/// What the law says at point q of element e, or who speaks in its place.
template <class E>
Moduli moduli_at(const Body& body, std::size_t e, std::size_t q, double x) {
  if (body.moduli == nullptr) return body.law(e).moduli(x);
  const std::size_t k = e * E::points + q;
  return {body.moduli->secant[k], body.moduli->derivative.empty() ? 0.0 : body.moduli->derivative[k]};
}

template <class E>
Gradient gradient_at(const Point<E>& point, const Nodal<E>& u) {
  Gradient h{};
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i)
      for (int k = 0; k < E::dim; ++k) h[i][k] += u[point.at(a, i)] * point.gradient[a][k];
  for (int a = 0; a < E::nodes; ++a) h[2][2] += u[point.at(a, 0)] * point.hoop[a];
  return h;
}

/// In plane stress without the strain across the plane: across() has it.
template <class E>
Strain strain_at(const Point<E>& point, const Nodal<E>& u) {
  const Gradient h = gradient_at<E>(point, u);
  Strain s;
  const double trace = h[0][0] + h[1][1] + h[2][2];
  s.dev = {h[0][0] - trace / 3.0,     h[1][1] - trace / 3.0,     h[2][2] - trace / 3.0,
           0.5 * (h[0][1] + h[1][0]), 0.5 * (h[1][2] + h[2][1]), 0.5 * (h[2][0] + h[0][2])};
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) s.trace += u[point.at(a, i)] * point.dilatation[a][i];
  return s;
}

/// With the strain z across the plane that leaves no stress there. Near ν = ½ the trace is a small difference
/// that the bulk modulus makes large again: it is taken from what says that nothing acts across.
Strain relaxed(const Law& law, double g, const Strain& plane, double z) {
  Strain whole = stretched(plane, z);
  if (law.bulk > g) whole.trace = -2.0 * g / law.bulk * whole.dev[2];
  return whole;
}

/// As strain_at, whole in plane stress too, where it is that of the frozen g.
Strain across(const Body& body, const Law& law, double g, const Strain& strain) {
  if (body.mesh.plane != PlaneState::stress) return strain;
  return relaxed(law, g, strain, 3.0 * transverse_ratio(law.bulk, g) * strain.dev[2]);
}

/// The same for the true law, or for what is said in its place.
template <class E>
Strain across(const Body& body, std::size_t e, std::size_t q, const Strain& strain) {
  if (body.mesh.plane != PlaneState::stress) return strain;
  if (body.moduli != nullptr)
    return across(body, body.law(e), body.moduli->secant[e * E::points + q], strain);
  const Law& law = body.law(e);
  const double third = -strain.dev[2];  // of the trace: there is no strain across yet
  const double z = transverse_strain(law, strain.dev[0] + third, strain.dev[1] + third, strain.dev[3]);
  return relaxed(law, law.secant(stretched(strain, z).norm()), strain, z);
}

/// The same of an increment as strain_at has it; in plane stress nothing acts across the plane.
Sym tangent_stress(const Body& body, const Law& law, const Moduli& moduli, const Strain& at,
                   const Strain& strain) {
  const Sym tau = tangent_stress(law, moduli, at, strain);
  if (body.mesh.plane != PlaneState::stress) return tau;
  const Sym of_unit = tangent_stress(law, moduli, at, stretched({}, 1.0));
  return tangent_stress(law, moduli, at, stretched(strain, -tau[2] / of_unit[2]));
}

/// f += the forces of the stress τ at this point.
template <class E>
void add_force(const Point<E>& point, const Sym& tau, Nodal<E>& f) {
  const double mean = (tau[0] + tau[1] + tau[2]) / 3.0;
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) {
      f[point.at(a, i)] += point.volume * mean * (point.dilatation[a][i] - point.trace(a, i));
      if (i == 0) f[point.at(a, i)] += point.volume * tau[2] * point.hoop[a];
      for (int k = 0; k < E::dim; ++k)
        f[point.at(a, i)] += point.volume * component(tau, i, k) * point.gradient[a][k];
    }
}

const std::int32_t* nodes_of(const Body& body, std::size_t element) {
  return body.mesh.connectivity.data() + element * nodes_per_element(body.mesh.type);
}

template <class E>
Nodal<E> gather(const Body& body, std::size_t element, std::span<const double> values) {
  Nodal<E> local;
  const std::int32_t* node = nodes_of(body, element);
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) local[Point<E>::at(a, i)] = values[Point<E>::at(node[a], i)];
  return local;
}

template <class E>
void scatter_add(const Body& body, std::size_t element, const Nodal<E>& local, std::span<double> values) {
  const std::int32_t* node = nodes_of(body, element);
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) values[Point<E>::at(node[a], i)] += local[Point<E>::at(a, i)];
}

/// The bulk modulus that strains within the plane meet.
double bulk_at(const Body& body, const Law& law, double g) {
  return body.mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g) : law.bulk;
}

/// Calls visit(element, law, point index, point, strain of `u` as strain_at has it) for every point.
template <class E, class Visit>
void for_each_point(const Body& body, std::span<const double> u, Visit&& visit) {
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
    const Nodal<E> local = gather<E>(body, e, u);
    const auto points = points_of<E>(x, body.law(e).mean_dilatation, body.mesh.plane);
    for (std::size_t q = 0; q < E::points; ++q)
      visit(e, body.law(e), q, points[q], strain_at<E>(points[q], local));
  }
}

/// y = Σ forces of stress_of(element, law, point index, point, strain of x).
template <class E, class StressOf>
void assemble(const Body& body, std::span<const double> x, std::span<double> y, StressOf&& stress_of) {
  std::fill(y.begin(), y.end(), 0.0);
  for_each_point<E>(
      body, x,
      [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& strain) {
        Nodal<E> f{};
        add_force<E>(point, stress_of(e, law, q, point, strain), f);
        scatter_add<E>(body, e, f, y);
      });
}

/// Columns of an element matrix: the forces of unit displacements. stress_of(point index, point, strain).
template <class E, class StressOf>
void fill_matrix(const Body& body, std::size_t element, std::span<double> matrix, StressOf&& stress_of) {
  const Nodal<E> x = gather<E>(body, element, body.mesh.coordinates);
  constexpr std::size_t n = std::tuple_size_v<Nodal<E>>;
  std::fill(matrix.begin(), matrix.end(), 0.0);
  const auto points = points_of<E>(x, body.law(element).mean_dilatation, body.mesh.plane);
  for (std::size_t q = 0; q < E::points; ++q) {
    const Point<E>& point = points[q];
    for (std::size_t column = 0; column < n; ++column) {
      Nodal<E> unit{}, f{};
      unit[column] = 1.0;
      add_force<E>(point, stress_of(q, point, strain_at<E>(point, unit)), f);
      for (std::size_t row = 0; row < n; ++row) matrix[row * n + column] += f[row];
    }
  }
}

}  // namespace

void secant(const Body& body, std::span<const double> u, std::span<double> g) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(body, u,
                      [&](std::size_t e, const Law&, std::size_t q, const Point<E>&, const Strain& plane) {
                        const double x = across<E>(body, e, q, plane).norm();
                        g[e * E::points + q] = moduli_at<E>(body, e, q, x).secant;
                      });
  });
}

void apply(const Body& body, std::span<const double> g, std::span<const double> x, std::span<double> y) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    assemble<E>(body, x, y,
                [&](std::size_t e, const Law& law, std::size_t q, const Point<E>&, const Strain& strain) {
                  const double at = g[e * E::points + q];
                  return stress(law, at, across(body, law, at, strain));
                });
  });
}

void apply_tangent(const Body& body, std::span<const double> u, std::span<const double> x,
                   std::span<double> y) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    assemble<E>(
        body, x, y,
        [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& strain) {
          const Strain at = across<E>(body, e, q, strain_at<E>(point, gather<E>(body, e, u)));
          return tangent_stress(body, law, moduli_at<E>(body, e, q, at.norm()), at, strain);
        });
  });
}

void diagonal(const Body& body, std::span<const double> g, std::span<double> d) {
  const std::size_t dim = dimension(body.mesh.type);
  std::vector<double> blocks(d.size() * dim);
  block_diagonal(body, g, blocks);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = blocks[i * dim + i % dim];
}

void block_diagonal(const Body& body, std::span<const double> g, std::span<double> blocks) {
  std::fill(blocks.begin(), blocks.end(), 0.0);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
      const std::int32_t* node = nodes_of(body, e);
      const auto points = points_of<E>(x, body.law(e).mean_dilatation, body.mesh.plane);
      for (std::size_t q = 0; q < E::points; ++q) {
        const Point<E>& point = points[q];
        const double secant = g[e * E::points + q];
        for (int a = 0; a < E::nodes; ++a)
          point.add_diagonal_block(a, bulk_at(body, body.law(e), secant), secant,
                                   blocks.data() + Point<E>::at(node[a], 0) * E::dim);
      }
    }
  });
}

void block_diagonal_tangent(const Body& body, std::span<const double> u, std::span<double> blocks) {
  std::fill(blocks.begin(), blocks.end(), 0.0);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(
        body, u,
        [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& plane) {
          const std::int32_t* node = nodes_of(body, e);
          const Strain strain = across<E>(body, e, q, plane);
          const double x = strain.norm();
          const auto [g, slope] = moduli_at<E>(body, e, q, x);
          double factor = slope != 0.0 ? 2.0 * slope / x : 0.0;
          Sym d = strain.dev;
          if (body.mesh.plane == PlaneState::stress) {
            const PlaneTerm term = condensed(law.bulk, g, factor, {d[0], d[1], d[2], d[3]});
            factor = term.factor;
            d = {term.xx, term.yy, 0.0, term.xy, 0.0, 0.0};
          }
          for (int a = 0; a < E::nodes; ++a) {
            double* block = blocks.data() + Point<E>::at(node[a], 0) * E::dim;
            point.add_diagonal_block(a, bulk_at(body, law, g), g, block);
            if (slope != 0.0) point.add_rank_one_block(a, factor, d, block);
          }
        });
  });
}

void residual(const Body& body, std::span<const double> u, std::span<double> f) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    assemble<E>(body, u, f,
                [&](std::size_t e, const Law& law, std::size_t q, const Point<E>&, const Strain& plane) {
                  const Strain strain = across<E>(body, e, q, plane);
                  return stress(law, moduli_at<E>(body, e, q, strain.norm()).secant, strain);
                });
  });
}

double energy(const Body& body, std::span<const double> u) {
  double sum = 0.0;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(
        body, u,
        [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& plane) {
          const Strain strain = across<E>(body, e, q, plane);
          const double shear =
              body.moduli == nullptr ? law.energy(strain.norm()) : body.moduli->energy[e * E::points + q];
          sum += point.volume * (0.5 * law.bulk * strain.trace * strain.trace + 2.0 * shear);
        });
  });
  return sum;
}

void element_matrix(const Body& body, std::size_t element, std::span<const double> g,
                    std::span<double> matrix) {
  const Law& law = body.law(element);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    fill_matrix<E>(body, element, matrix, [&](std::size_t q, const Point<E>&, const Strain& strain) {
      return stress(law, g[q], across(body, law, g[q], strain));
    });
  });
}

void element_tangent(const Body& body, std::size_t element, std::span<const double> u,
                     std::span<double> matrix) {
  const Law& law = body.law(element);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    const Nodal<E> local = gather<E>(body, element, u);
    fill_matrix<E>(body, element, matrix, [&](std::size_t q, const Point<E>& point, const Strain& strain) {
      const Strain at = across<E>(body, element, q, strain_at<E>(point, local));
      return tangent_stress(body, law, moduli_at<E>(body, element, q, at.norm()), at, strain);
    });
  });
}

void volumes(const Body& body, std::span<double> volume) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
      volume[e] = 0.0;
      for (std::size_t q = 0; q < E::points; ++q) volume[e] += Point<E>(x, q, body.mesh.plane).volume;
    }
  });
}

void fields(const Body& body, std::span<const double> u, const ElementFields& out) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const Law& law = body.law(e);
      const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
      const Nodal<E> local = gather<E>(body, e, u);
      Sym tau{};
      double volume = 0.0, dev_strain = 0.0, g_mean = 0.0, von_mises = 0.0, largest = 0.0, rotation = 0.0;
      bool plastic = false;
      const auto points = points_of<E>(x, law.mean_dilatation, body.mesh.plane);
      for (std::size_t q = 0; q < E::points; ++q) {
        const Point<E>& point = points[q];
        const Strain strain = across<E>(body, e, q, strain_at<E>(point, local));
        const double norm = strain.norm(), g = moduli_at<E>(body, e, q, norm).secant;
        const Sym point_tau = stress(law, g, strain);
        for (std::size_t i = 0; i < 6; ++i) tau[i] += point.volume * point_tau[i];
        volume += point.volume;
        dev_strain += point.volume * norm;
        g_mean += point.volume * g;
        von_mises += point.volume * std::sqrt(1.5) * 2.0 * g * norm;
        plastic = plastic || law.plastic(norm);
        if (out.strain.empty() && out.rotation.empty()) continue;
        Gradient h = gradient_at<E>(point, local);
        if (body.mesh.plane == PlaneState::stress) h[2][2] = strain.dev[2] + strain.trace / 3.0;
        largest = std::max(largest, largest_principal(h));
        rotation = std::max(rotation, rotation_angle(h));
      }
      if (!out.stress.empty())
        for (std::size_t i = 0; i < 6; ++i) out.stress[6 * e + i] = tau[i] / volume;
      if (!out.von_mises.empty()) out.von_mises[e] = von_mises / volume;
      if (!out.dev_strain.empty()) out.dev_strain[e] = dev_strain / volume;
      if (!out.secant.empty()) out.secant[e] = g_mean / volume;
      if (!out.plastic.empty()) out.plastic[e] = plastic ? 1 : 0;
      if (!out.strain.empty()) out.strain[e] = largest;
      if (!out.rotation.empty()) out.rotation[e] = rotation;
    }
  });
}

void strains(const Body& body, std::span<const double> u, std::span<double> out) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(
        body, u, [&](std::size_t e, const Law&, std::size_t q, const Point<E>&, const Strain& plane) {
          const Strain strain = across<E>(body, e, q, plane);
          for (std::size_t i = 0; i < 6; ++i)
            out[6 * (e * E::points + q) + i] = strain.dev[i] + (i < 3 ? strain.trace / 3.0 : 0.0);
        });
  });
}

void points(const Body& body, std::span<double> position, std::span<double> weight) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t k = 0; k < body.mesh.element_count() * E::points; ++k) {
      const std::size_t q = k % E::points;
      const Nodal<E> x = gather<E>(body, k / E::points, body.mesh.coordinates);
      if (!weight.empty()) weight[k] = Point<E>(x, q, body.mesh.plane).volume;
      const auto shape = E::values(E::point[q].data());
      for (std::size_t i = 0; i < E::dim && !position.empty(); ++i) {
        position[k * E::dim + i] = 0.0;
        for (int a = 0; a < E::nodes; ++a) position[k * E::dim + i] += shape[a] * x[a * E::dim + i];
      }
    }
  });
}

void point_fields(const Body& body, std::span<const double> u, const PointFields& out) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(
        body, u,
        [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& plane) {
          const std::size_t k = e * E::points + q;
          const Strain strain = across<E>(body, e, q, plane);
          const Sym tau = stress(law, moduli_at<E>(body, e, q, strain.norm()).secant, strain);
          std::copy(tau.begin(), tau.end(), &out.stress[6 * k]);
          for (std::size_t i = 0; i < 6; ++i)
            out.strain[6 * k + i] = strain.dev[i] + (i < 3 ? strain.trace / 3.0 : 0.0);
          out.volume[k] = point.volume;
          const auto shape = E::values(E::point[q].data());
          const std::int32_t* node = nodes_of(body, e);
          out.position[k] = {};
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < E::dim; ++i)
              out.position[k][i] += shape[a] * body.mesh.coordinates[Point<E>::at(node[a], i)];
        });
  });
}

}  // namespace kacanov::reference
