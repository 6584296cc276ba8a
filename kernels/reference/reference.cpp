// SPDX-License-Identifier: BSD-3-Clause
// The operator as one plain loop per element, the same for every element type.
#include <kacanov/reference.hpp>

#include <algorithm>
#include <vector>

#include "reference/element_points.hpp"

namespace kacanov::reference {
namespace {

/// Tangent stress of the increment strain_at(), condensed in plane stress.
Sym tangent_stress(const Body& body, const Law& law, const Moduli& moduli, const Strain& at,
                   const Strain& strain) {
  const Sym tau = tangent_stress(law, moduli, at, strain);
  if (body.mesh.plane != PlaneState::stress) return tau;
  const Sym of_unit = tangent_stress(law, moduli, at, stretched({}, 1.0));
  return tangent_stress(law, moduli, at, stretched(strain, -tau[2] / of_unit[2]));
}

/// f += nodal forces of the stress τ at this point.
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

template <class E>
void scatter_add(const Body& body, std::size_t element, const Nodal<E>& local, std::span<double> values) {
  const std::int32_t* node = nodes_of(body, element);
  for (int a = 0; a < E::nodes; ++a)
    for (int i = 0; i < E::dim; ++i) values[Point<E>::at(node[a], i)] += local[Point<E>::at(a, i)];
}

/// Bulk modulus for in-plane strains.
double bulk_at(const Body& body, const Law& law, double g) {
  return body.mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g) : law.bulk;
}

/// y = Σ forces of stress_of(element, law, point index, point, strain of x); `known` as in for_each_point.
template <class E, class StressOf>
void assemble(const Body& body, std::span<const double> x, std::span<const double> known, std::span<double> y,
              StressOf&& stress_of) {
  std::fill(y.begin(), y.end(), 0.0);
  Nodal<E> f{};
  for_each_point<E>(
      body, x, known,
      [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& strain) {
        if (q == 0) f = {};
        add_force<E>(point, stress_of(e, law, q, point, strain), f);
        if (q + 1 == E::points) scatter_add<E>(body, e, f, y);
      });
}

/// Energy stored at a point, from the strain as across() returns it.
template <class E>
double stored(const Body& body, std::size_t e, std::size_t q, const Point<E>& point, const Strain& strain) {
  const Law& law = body.law(e);
  const bool averaged = E::corner_dilatation && law.mean_dilatation;
  const double square = averaged ? strain.square : strain.trace * strain.trace;
  const double shear =
      body.moduli == nullptr ? law.energy(strain.norm()) : body.moduli->energy[e * E::points + q];
  return point.volume * (0.5 * law.bulk * square + 2.0 * shear);
}

/// Columns of an element matrix: forces of unit displacements. stress_of(point index, point, strain).
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
    for_each_plain_point<E>(
        body, u, [&](std::size_t e, const Law&, std::size_t q, const Point<E>&, const Strain& plane) {
          const double x = across<E>(body, e, q, plane).norm();
          g[e * E::points + q] = moduli_at<E>(body, e, q, x).secant;
        });
  });
}

void apply(const Body& body, std::span<const double> g, std::span<const double> x, std::span<double> y) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    assemble<E>(body, x, {}, y,
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
        body, x, {}, y,
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
    for_each_plain_point<E>(
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
    assemble<E>(body, u, body.corner_dilatation, f,
                [&](std::size_t e, const Law& law, std::size_t q, const Point<E>&, const Strain& plane) {
                  const Strain strain = across<E>(body, e, q, plane);
                  return stress(law, moduli_at<E>(body, e, q, strain.norm()).secant, strain);
                });
  });
}

double response(const Body& body, std::span<const double> u, std::span<double> f) {
  double energy = 0.0;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    assemble<E>(
        body, u, body.corner_dilatation, f,
        [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& plane) {
          const Strain strain = across<E>(body, e, q, plane);
          energy += stored<E>(body, e, q, point, strain);
          return stress(law, moduli_at<E>(body, e, q, strain.norm()).secant, strain);
        });
  });
  return energy;
}

double free_force(const Body& body, std::span<double> f) {
  const std::vector<double> rest(body.unknowns(), 0.0);
  double energy = 0.0;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    assemble<E>(body, rest, {}, f,
                [&](std::size_t e, const Law& law, std::size_t, const Point<E>& point, const Strain& strain) {
                  const double shear = law.secant(0.0);
                  const Strain all = across(body, law, shear, widened(strain, free_strain_of(body, e)));
                  energy += point.volume *
                            (0.5 * law.bulk * all.trace * all.trace + shear * inner(all.dev, all.dev));
                  return stress(law, shear, all);
                });
  });
  return energy;
}

double expansion_force(const Body& body, std::span<const double> pressure, std::span<double> f) {
  std::fill(f.begin(), f.end(), 0.0);
  const std::size_t width = pressure.size() / std::max(body.mesh.element_count(), std::size_t{1});
  double energy = 0.0;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const std::span<const double> here = pressure.subspan(e * width, width);
      const Law& law = body.law(e);
      const double stiffness =
          body.mesh.plane == PlaneState::stress ? plane_stress_expansion(law) : 2.0 * law.bulk;
      const auto points = points_of<E>(gather<E>(body, e, body.mesh.coordinates), false, body.mesh.plane);
      Nodal<E> local{};
      for (std::size_t q = 0; q < E::points; ++q) {
        double p = here[0];
        if (width > 1) {
          const auto share = elements::barycentric<E::dim>(E::point[q].data());
          p = 0.0;
          for (std::size_t c = 0; c < share.size(); ++c) p += share[c] * here[1 + c];
        }
        const Point<E>& point = points[q];
        energy += point.volume * p * p / stiffness;
        for (int a = 0; a < E::nodes; ++a)
          for (int i = 0; i < E::dim; ++i)
            local[point.at(a, i)] +=
                point.volume * p * (point.gradient[a][i] + (i == 0 ? point.hoop[a] : 0.0));
      }
      scatter_add<E>(body, e, local, f);
    }
  });
  return energy;
}

double energy(const Body& body, std::span<const double> u) {
  double sum = 0.0;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(
        body, u, body.corner_dilatation,
        [&](std::size_t e, const Law&, std::size_t q, const Point<E>& point, const Strain& plane) {
          sum += stored<E>(body, e, q, point, across<E>(body, e, q, plane));
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

}  // namespace kacanov::reference
