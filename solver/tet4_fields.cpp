// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of straight tetrahedra, where they are the same all over an element.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <kacanov/vector3.hpp>
#include "cells/tet4.hpp"
#include "field_loops.hpp"
#include "lanes.hpp"
#include "reference/element_points.hpp"

namespace kacanov::tet4 {
namespace {

/// Elements in a row: 30 ns an element against 100 of the reference.
struct Abreast {
  Lanes x[4][3], moved[4][3];
  Lanes gradient[3][3];  ///< ∂u_i/∂x_k
  Lanes volume;

  void gather(const Body& body, std::span<const double> u, std::size_t first) {
    const ElementsAbreast row = in_a_row(first, body.mesh.element_count());
    kacanov::gather(body.mesh, row, body.mesh.coordinates, x);
    kacanov::gather(body.mesh, row, u, moved);
  }

  void work_out() {
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      double j[3][3], d[3][3], h[3][3];  // j, d: along the edges from the first corner
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          j[i][k] = x[k + 1][i][lane] - x[0][i][lane];
          d[i][k] = moved[k + 1][i][lane] - moved[0][i][lane];
        }
      volume[lane] = map_gradient(j, d, h) / 6.0;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) gradient[i][k][lane] = h[i][k];
    }
  }

  Vector3 middle_of(std::size_t lane) const {
    Vector3 middle;
    for (std::size_t i = 0; i < 3; ++i)
      middle[i] = 0.25 * (x[0][i][lane] + x[1][i][lane] + x[2][i][lane] + x[3][i][lane]);
    return middle;
  }
};

reference::Strain strain_of(const reference::Gradient& h) {
  reference::Strain s;
  s.trace = h[0][0] + h[1][1] + h[2][2];
  s.square = s.trace * s.trace;
  const double mean = s.trace / 3.0;
  s.dev = {h[0][0] - mean,
           h[1][1] - mean,
           h[2][2] - mean,
           0.5 * (h[0][1] + h[1][0]),
           0.5 * (h[1][2] + h[2][1]),
           0.5 * (h[2][0] + h[0][2])};
  return s;
}

/// The strain that a law sees: with means of tr ε round the corners where it has those.
class Strains {
 public:
  Strains(const Body& body, std::span<const double> u)
      : body_(body), means_(body, u, body.corner_dilatation) {}
  reference::Strain operator()(std::size_t element, const reference::Gradient& h) const {
    reference::Strain strain = strain_of(h);
    means_.put<elements::Tet4>(body_.law(element), element, 0, strain);
    return strain;
  }

 private:
  const Body& body_;
  reference::CornerDilatation means_;
};

/// Calls visit(element, elements abreast, lane).
template <class Visit>
void for_each_element(const Body& body, std::span<const double> u, const Visit& visit) {
  const std::size_t elements = body.mesh.element_count();
  Abreast some;
  for (std::size_t first = 0; first < elements; first += abreast) {
    some.gather(body, u, first);
    some.work_out();
    const std::size_t count = std::min(abreast, elements - first);
    for (std::size_t lane = 0; lane < count; ++lane) visit(first + lane, some, lane);
  }
}

void fields(const Body& body, std::span<const double> u, const reference::ElementFields& out) {
  const bool moduli = !out.stress.empty() || !out.von_mises.empty() || !out.secant.empty();
  const Strains strains(body, u);
  for_each_element(body, u, [&](std::size_t e, const Abreast& some, std::size_t lane) {
    const reference::Gradient h = gradient_of(some.gradient, lane);
    const reference::Strain strain = strains(e, h);
    const Law& law = body.law(e);
    const double norm = strain.norm(), g = moduli ? law.secant(norm) : 0.0;
    if (!out.stress.empty()) {
      const reference::Sym tau = reference::stress(law, g, strain);
      std::copy(tau.begin(), tau.end(), &out.stress[6 * e]);
    }
    if (!out.von_mises.empty()) out.von_mises[e] = std::sqrt(1.5) * 2.0 * g * norm;
    if (!out.dev_strain.empty()) out.dev_strain[e] = norm;
    if (!out.secant.empty()) out.secant[e] = g;
    if (!out.plastic.empty()) out.plastic[e] = law.plastic(norm) ? 1 : 0;
    if (!out.strain.empty()) out.strain[e] = reference::largest_principal(h);
    if (!out.rotation.empty()) out.rotation[e] = reference::rotation_angle(h);
    if (!out.volume.empty()) out.volume[e] = some.volume[lane];
  });
}

void point_fields(const Body& body, std::span<const double> u, const reference::PointFields& out) {
  const Strains strains(body, u);
  for_each_element(body, u, [&](std::size_t e, const Abreast& some, std::size_t lane) {
    const reference::Strain strain = strains(e, gradient_of(some.gradient, lane));
    if (!out.stress.empty()) {
      const Law& law = body.law(e);
      const reference::Sym tau = reference::stress(law, law.secant(strain.norm()), strain);
      std::copy(tau.begin(), tau.end(), &out.stress[6 * e]);
    }
    for (std::size_t i = 0; i < 6 && !out.strain.empty(); ++i)
      out.strain[6 * e + i] = strain.dev[i] + (i < 3 ? strain.trace / 3.0 : 0.0);
    if (!out.volume.empty()) out.volume[e] = some.volume[lane];
    if (!out.position.empty()) out.position[e] = some.middle_of(lane);
  });
}

double energy(const Body& body, std::span<const double> u) {
  double sum = 0.0;
  const Strains strains(body, u);
  for_each_element(body, u, [&](std::size_t e, const Abreast& some, std::size_t lane) {
    const reference::Strain strain = strains(e, gradient_of(some.gradient, lane));
    const Law& law = body.law(e);
    sum += some.volume[lane] * (0.5 * law.bulk * strain.square + 2.0 * law.energy(strain.norm()));
  });
  return sum;
}

void volumes(const Body& body, std::span<double> volume) {
  for_each_element(body, body.mesh.coordinates, [&](std::size_t e, const Abreast& some, std::size_t lane) {
    volume[e] = some.volume[lane];
  });
}

}  // namespace
}  // namespace kacanov::tet4

const kacanov::FieldLoops kacanov::tet4_loops{tet4::fields, tet4::point_fields, tet4::energy, tet4::volumes};
