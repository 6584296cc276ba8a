// SPDX-License-Identifier: BSD-3-Clause
// Loops of the reference over elements and points, with the strain that enters the law there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>
#include "cells/elements.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"
#include "reference/point_strain.hpp"

namespace kacanov::reference {

using elements::Nodal;
using elements::Point;
using elements::points_of;

/// Moduli at point q of element e, from the law or from Body::moduli.
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

/// Averages of tr ε around the corners of elements, at some displacement.
class CornerDilatation {
 public:
  /// Averages of u, or `known` if that is not empty (Body::corner_dilatation, which must outlive this
  /// object).
  CornerDilatation(const Body& body, std::span<const double> u, std::span<const double> known);
  CornerDilatation(const CornerDilatation&) = delete;
  CornerDilatation& operator=(const CornerDilatation&) = delete;

  /// Replaces the trace of the strain at point q if the element's law averages it.
  template <class E>
  void put(const Law& law, std::size_t e, std::size_t q, Strain& strain) const {
    if constexpr (E::corner_dilatation)
      if (law.mean_dilatation) {
        const auto share = elements::barycentric<E::dim>(E::point[q].data());
        strain.trace = strain.square = 0.0;
        for (std::size_t c = 0; c < share.size(); ++c) {
          const double mean = values_[e * corners_ + c];
          strain.trace += share[c] * mean;
          strain.square += share[c] * mean * mean;
        }
      }
  }

 private:
  std::size_t corners_;
  std::vector<double> own_;
  std::span<const double> values_;
};

/// The strain at a point; in plane stress without the transverse strain, which across() adds.
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

/// Adds the transverse strain z at which the transverse stress vanishes. Near ν = ½ the trace is a small
/// difference that the bulk modulus amplifies: it is computed from the condition of zero transverse stress
/// instead.
inline Strain relaxed(const Law& law, double g, const Strain& plane, double z) {
  Strain whole = stretched(plane, z);
  if (law.bulk > g) whole.trace = -2.0 * g / law.bulk * whole.dev[2];
  return whole;
}

/// strain_at() with the transverse strain of the frozen g in plane stress.
inline Strain across(const Body& body, const Law& law, double g, const Strain& strain) {
  if (body.mesh.plane != PlaneState::stress) return strain;
  return relaxed(law, g, strain, 3.0 * transverse_ratio(law.bulk, g) * strain.dev[2]);
}

inline double free_strain_of(const Body& body, std::size_t e) {
  return body.free_strain.empty() ? 0.0 : body.free_strain[e];
}

/// Adds the same strain in both in-plane directions, without transverse strain.
inline Strain widened(Strain strain, double by) {
  strain.trace += 2.0 * by;
  strain.dev[0] += by / 3.0, strain.dev[1] += by / 3.0, strain.dev[2] -= 2.0 / 3.0 * by;
  return strain;
}

/// strain_at() minus the free strain, with the transverse strain of the true law or of Body::moduli.
template <class E>
Strain across(const Body& body, std::size_t e, std::size_t q, const Strain& total) {
  if (body.mesh.plane != PlaneState::stress) return total;
  const Strain strain = widened(total, -free_strain_of(body, e));
  if (body.moduli != nullptr)
    return across(body, body.law(e), body.moduli->secant[e * E::points + q], strain);
  const Law& law = body.law(e);
  const double third = -strain.dev[2];  // of the trace: the transverse strain is still zero
  const double z = transverse_strain(law, strain.dev[0] + third, strain.dev[1] + third, strain.dev[3]);
  return relaxed(law, law.secant(stretched(strain, z).norm()), strain, z);
}

inline const std::int32_t* nodes_of(const Body& body, std::size_t element) {
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

/// Calls visit(element, law, point index, point, strain_at() of `u`) for every point.
template <class E, class Visit>
void for_each_plain_point(const Body& body, std::span<const double> u, Visit&& visit) {
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
    const Nodal<E> local = gather<E>(body, e, u);
    const auto points = points_of<E>(x, body.law(e).mean_dilatation, body.mesh.plane);
    for (std::size_t q = 0; q < E::points; ++q)
      visit(e, body.law(e), q, points[q], strain_at<E>(points[q], local));
  }
}

/// The same with averages around the corners where laws use them; `known` as in CornerDilatation.
template <class E, class Visit>
void for_each_point(const Body& body, std::span<const double> u, std::span<const double> known,
                    Visit&& visit) {
  const CornerDilatation means(body, u, known);
  for_each_plain_point<E>(
      body, u, [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, Strain strain) {
        means.put<E>(law, e, q, strain);
        visit(e, law, q, point, strain);
      });
}

}  // namespace kacanov::reference
