// SPDX-License-Identifier: BSD-3-Clause
// Error of the strains relative to recovered ones, point by point.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "cells/elements.hpp"
#include "law/plane_stress.hpp"
#include "recovery/element_batch.hpp"
#include "recovery/error_quadrature.hpp"
#include "recovery/spr_patches.hpp"

namespace kacanov {
namespace {

/// Response of a law to a strain.
struct StrainResponse {
  double trace = 0.0, g = 0.0;
  Patches::Values dev{};
};

StrainResponse respond(const Law& law, const Patches::Values& strain) {
  StrainResponse r;
  r.trace = strain[0] + strain[1] + strain[2];
  double square = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    r.dev[i] = strain[i] - (i < 3 ? r.trace / 3.0 : 0.0);
    square += (i < 3 ? 1.0 : 2.0) * r.dev[i] * r.dev[i];
  }
  r.g = law.secant(std::sqrt(square));
  return r;
}

/// Returns ½ (τ(a) − τ(b)) : (a − b) from the response to a; nonnegative if stress does not decrease with
/// strain.
double energy_between(const Law& law, const StrainResponse& ra, const Patches::Values& b) {
  const StrainResponse rb = respond(law, b);
  const double trace = ra.trace - rb.trace;
  double work = law.bulk * trace * trace;
  for (std::size_t i = 0; i < 6; ++i)
    work += (i < 3 ? 2.0 : 4.0) * (ra.g * ra.dev[i] - rb.g * rb.dev[i]) * (ra.dev[i] - rb.dev[i]);
  return std::max(0.0, 0.5 * work);
}

/// Position, strain and volume at a point of an element.
struct Sample {
  Vector3 position{};
  Patches::Values strain{};
  double volume = 0.0;
};

/// Coordinates and displacements of an element's nodes. Loops over nodes have constant length.
template <class E>
struct ElementAt {
  double x[E::nodes][3] = {}, u[E::nodes][3] = {};

  ElementAt(const Part& part, std::span<const double> displacement, std::size_t element) {
    for (std::size_t a = 0; a < E::nodes; ++a) {
      const auto node = static_cast<std::size_t>(part.elements[element * E::nodes + a]);
      for (std::size_t i = 0; i < E::dim; ++i) {
        x[a][i] = part.coordinates[node * E::dim + i];
        u[a][i] = displacement[node * E::dim + i];
      }
    }
  }

  Sample sample(const ErrorQuadraturePoint& point, PlaneState plane) const {
    Sample out;
    double jacobian[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, along[3][3] = {}, h[3][3];
    for (std::size_t i = 0; i < E::dim; ++i) {
      jacobian[i][i] = 0.0;
      for (std::size_t a = 0; a < E::nodes; ++a) {
        out.position[i] += point.value[a] * x[a][i];
        for (std::size_t k = 0; k < E::dim; ++k) {
          jacobian[i][k] += (x[a][i] - x[0][i]) * point.gradient[a * E::dim + k];
          along[i][k] += u[a][i] * point.gradient[a * E::dim + k];
        }
      }
    }
    out.volume = point.weight * map_gradient(jacobian, along, h);
    out.strain = {h[0][0],
                  h[1][1],
                  h[2][2],
                  0.5 * (h[0][1] + h[1][0]),
                  0.5 * (h[1][2] + h[2][1]),
                  0.5 * (h[2][0] + h[0][2])};
    if (plane == PlaneState::axisymmetric) {
      double along_radius = 0.0;
      for (std::size_t a = 0; a < E::nodes; ++a) along_radius += point.value[a] * u[a][0];
      out.strain[2] = along_radius / out.position[0];
      out.volume *= 2.0 * std::numbers::pi * out.position[0];
    }
    return out;
  }
};

/// Compares the strains of a solution with recovered ones.
class Comparison {
 public:
  explicit Comparison(const Smoothing& of)
      : of_(of), body_(of.part.body()), points_(error_quadrature_points(cell(of.part.type))) {}

  template <class E>
  double energy_in(std::size_t element, double mean_trace) const {
    const Law& law = body_.law(element);
    constexpr std::size_t corners = E::corners;
    const std::int32_t* node = &of_.part.elements[element * E::nodes];
    const ElementAt<E> moved(of_.part, of_.state.u, element);
    std::array<Patches::Polynomial, corners> of_corner;
    for (std::size_t a = 0; a < corners; ++a)
      of_corner[a] = of_.patches.polynomial(of_.fits, of_.set, static_cast<std::size_t>(node[a]));
    double energy = 0.0;
    for (const ErrorQuadraturePoint& point : points_) {
      Sample here = moved.sample(point, of_.part.plane);
      if (law.mean_dilatation) {
        double trace = mean_trace;
        if (E::order > 1 && averages_at_corners(law, of_.part.type)) {
          trace = 0.0;
          for (std::size_t a = 0; a < corners; ++a)
            trace += point.corner_share[a] * of_.state.corner_dilatation[element * corners + a];
        }
        const double more = trace - (here.strain[0] + here.strain[1] + here.strain[2]);
        for (std::size_t c = 0; c < 3; ++c) here.strain[c] += more / 3.0;
      }
      Patches::Values smooth{};
      for (std::size_t a = 0; a < corners; ++a) {
        const Patches::Values value = of_corner[a](here.position);
        for (std::size_t c = 0; c < 6; ++c) smooth[c] += point.corner_share[a] * value[c];
      }
      if (of_.part.plane == PlaneState::stress) relax(element, here.strain), relax(element, smooth);
      energy += here.volume * energy_between(law, respond(law, here.strain), smooth);
    }
    return energy;
  }

 private:
  /// Subtracts the free strain of the element, and sets the transverse strain of plane stress.
  void relax(std::size_t element, Patches::Values& strain) const {
    const double longer = of_.free_strain.empty() ? 0.0 : of_.free_strain[element];
    strain[0] -= longer, strain[1] -= longer;
    strain[2] = transverse_strain(body_.law(element), strain[0], strain[1], strain[3]);
  }

  const Smoothing& of_;
  Body body_;
  std::vector<ErrorQuadraturePoint> points_;
};

}  // namespace

void reference_errors(const Smoothing& of, std::int32_t batch, std::span<double> energy) {
  const Comparison comparison(of);
  elements::dispatch(of.part.type, [&]<class E>(E) {
    for (std::size_t e = 0; e < energy.size(); ++e)
      if (of.patches.is_in(e, batch)) energy[e] = comparison.energy_in<E>(e, of.mean_trace[e]);
  });
}

}  // namespace kacanov
