// SPDX-License-Identifier: BSD-3-Clause
// How far a solution is from that of a mesh without end: an estimate from the solution itself.
#include <kacanov/discretisation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>

#include <kacanov/corner_means.hpp>
#include "cells/dispatch.hpp"
#include "finer_rule.hpp"
#include "lanes.hpp"
#include "law/plane_stress.hpp"
#include "linear/free_strain.hpp"
#include "patches.hpp"

namespace kacanov {
namespace {

/// Of a strain.
struct Response {
  double trace = 0.0, g = 0.0;
  Patches::Values dev{};
};

Response respond(const Law& law, const Patches::Values& strain) {
  Response r;
  r.trace = strain[0] + strain[1] + strain[2];
  double square = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    r.dev[i] = strain[i] - (i < 3 ? r.trace / 3.0 : 0.0);
    square += (i < 3 ? 1.0 : 2.0) * r.dev[i] * r.dev[i];
  }
  r.g = law.secant(std::sqrt(square));
  return r;
}

/// ½ (τ(a) − τ(b)) : (a − b), with what the law says of a; which is not negative where stress does not fall
/// with strain.
double energy_between(const Law& law, const Response& ra, const Patches::Values& b) {
  const Response rb = respond(law, b);
  const double trace = ra.trace - rb.trace;
  double work = law.bulk * trace * trace;
  for (std::size_t i = 0; i < 6; ++i)
    work += (i < 3 ? 2.0 : 4.0) * (ra.g * ra.dev[i] - rb.g * rb.dev[i]) * (ra.dev[i] - rb.dev[i]);
  return std::max(0.0, 0.5 * work);
}

/// Of the cell with straight edges and the same corners.
const Cell& straight(const Cell& type) {
  for (const Cell& other : cells())
    if (other.dim == type.dim && other.corners == type.corners && other.order == 1) return other;
  throw std::logic_error("no straight cell for " + std::string(type.name));
}

/// A point of the finer rule, with what shape functions have there.
struct FinePoint {
  double weight = 0.0;
  std::vector<double> gradient;      ///< nodes × dim, along reference coordinates
  std::vector<double> value;         ///< nodes
  std::vector<double> corner_share;  ///< corners: of the straight cell
};

std::vector<FinePoint> fine_points(const Cell& type) {
  std::vector<FinePoint> all;
  for (const QuadraturePoint& point : finer_rule(type)) {
    FinePoint one{point.weight, std::vector<double>(static_cast<std::size_t>(type.nodes * type.dim)),
                  std::vector<double>(static_cast<std::size_t>(type.nodes)),
                  std::vector<double>(static_cast<std::size_t>(type.corners))};
    type.gradients(point.xi.data(), one.gradient.data());
    type.values(point.xi.data(), one.value.data());
    straight(type).values(point.xi.data(), one.corner_share.data());
    all.push_back(std::move(one));
  }
  return all;
}

/// Position, strain and volume at a point of an element.
struct Sample {
  Vector3 position{};
  Patches::Values strain{};
  double volume = 0.0;
};

/// An element with what its nodes move by. Loops over nodes are of known length.
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

  Sample sample(const FinePoint& point, PlaneState plane) const {
    Sample out;
    double jacobian[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, along[3][3] = {}, h[3][3];
    for (std::size_t i = 0; i < E::dim; ++i) {
      jacobian[i][i] = 0.0;
      for (std::size_t a = 0; a < E::nodes; ++a) {
        out.position[i] += point.value[a] * x[a][i];
        for (std::size_t k = 0; k < E::dim; ++k) {
          jacobian[i][k] += x[a][i] * point.gradient[a * E::dim + k];
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

/// The strains of a solution beside smoother ones.
class Comparison {
 public:
  Comparison(const Part& part, const BodyState& state)
      : part_(part),
        state_(state),
        body_(part.body()),
        free_strain_(free_strain(part, state.thermal)),
        type_(cell(part.type)),
        even_(type_.simplex && type_.order == 1 && part.plane != PlaneState::axisymmetric),
        points_(fine_points(type_)),
        patches_(part) {}

  std::vector<double> run() {
    std::vector<double> of_element(part_.element_count(), 0.0);
    for (std::int32_t batch = 0; batch < patches_.batches(); ++batch) {
      PatchFits fits = patches_.fits();
      std::vector<double> trace(even_ ? 0 : part_.element_count());  // B-bar's is even in an element
      visit_strains(batch, [&](std::size_t e, const Vector3& position, const double* strain, double) {
        patches_.add(fits, e, position, strain);
        if (!even_) trace[e] = strain[0] + strain[1] + strain[2];
      });
      patches_.solve(fits);
      if (even_) {
        visit_strains(batch, [&](std::size_t e, const Vector3&, const double* strain, double volume) {
          of_element[e] = type_.dim == 3 ? energy_in_even<3>(e, fits, strain, volume)
                                         : energy_in_even<2>(e, fits, strain, volume);
        });
        continue;
      }
      elements::dispatch(part_.type, [&]<class E>(E) {
        for (std::size_t e = 0; e < of_element.size(); ++e)
          if (patches_.is_in(e, batch)) of_element[e] = energy_in<E>(e, fits, trace[e]);
      });
    }
    return of_element;
  }

 private:
  /// Calls visit(element, position, strain, volume) for the points of a batch.
  template <class Visit>
  void visit_strains(std::int32_t batch, const Visit& visit) const {
    const std::size_t points = type_.points.size();
    visit_points(part_, state_, PointValues::all_but_stress, [&](const PointRun& run) {
      for (std::size_t k = 0; k < run.volume.size(); ++k)
        if (const std::size_t e = run.first + k / points; patches_.is_in(e, batch))
          visit(e, run.position[k], &run.strain[6 * k], run.volume[k]);
    });
  }

  /// sum += share of a linear polynomial's values at `position`. Loops of known length.
  template <std::size_t dim, class Position>
  static void add_linear(const Patches::Polynomial& of, double share, const Position& position,
                         Patches::Values& sum) {
    const double* coefficient = of.coefficients;
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += share * coefficient[v];
    for (std::size_t i = 0; i < dim; ++i) {
      const double along = share * of.scale * (position[i] - of.centre[i]);
      coefficient += sum.size();
      for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += along * coefficient[v];
    }
  }

  /// energy_in() of a straight simplex of so many dimensions, whose strain is the same all over it. Its
  /// polynomials are linear: 110 ns a tet4 beside the law in loops of known length, in place of 260.
  template <std::size_t dim>
  double energy_in_even(std::size_t element, const PatchFits& fits, const double* strain,
                        double volume) const {
    const Law& law = body_.law(element);
    const std::int32_t* node = &part_.elements[element * (dim + 1)];
    std::array<Patches::Polynomial, dim + 1> of_corner;
    for (std::size_t a = 0; a <= dim; ++a)
      of_corner[a] = patches_.polynomial(fits, static_cast<std::size_t>(node[a]));
    Patches::Values here;
    std::copy_n(strain, here.size(), here.begin());
    if (part_.plane == PlaneState::stress) relax(element, here);
    const Response response = respond(law, here);
    double energy = 0.0, weights = 0.0;
    for (const FinePoint& point : points_) {
      std::array<double, dim> position{};
      for (std::size_t a = 0; a <= dim; ++a)
        for (std::size_t i = 0; i < dim; ++i) position[i] += point.corner_share[a] * of_corner[a].centre[i];
      Patches::Values smooth{};
      for (std::size_t a = 0; a <= dim; ++a)
        add_linear<dim>(of_corner[a], point.corner_share[a], position, smooth);
      if (part_.plane == PlaneState::stress) relax(element, smooth);
      energy += point.weight * energy_between(law, response, smooth);
      weights += point.weight;
    }
    return volume / weights * energy;
  }

  template <class E>
  double energy_in(std::size_t element, const PatchFits& fits, double mean_trace) const {
    const Law& law = body_.law(element);
    constexpr std::size_t corners = E::corners;
    const std::int32_t* node = &part_.elements[element * E::nodes];
    const ElementAt<E> moved(part_, state_.u, element);
    std::array<Patches::Polynomial, corners> of_corner;
    for (std::size_t a = 0; a < corners; ++a)
      of_corner[a] = patches_.polynomial(fits, static_cast<std::size_t>(node[a]));
    double energy = 0.0;
    for (const FinePoint& point : points_) {
      Sample here = moved.sample(point, part_.plane);
      if (law.mean_dilatation) {
        double trace = mean_trace;
        if (averages_at_corners(law, part_.type)) {
          trace = 0.0;
          for (std::size_t a = 0; a < corners; ++a)
            trace += point.corner_share[a] * state_.corner_dilatation[element * corners + a];
        }
        const double more = trace - (here.strain[0] + here.strain[1] + here.strain[2]);
        for (std::size_t c = 0; c < 3; ++c) here.strain[c] += more / 3.0;
      }
      Patches::Values smooth{};
      for (std::size_t a = 0; a < corners; ++a) {
        if constexpr (E::order == 1) {
          add_linear<E::dim>(of_corner[a], point.corner_share[a], here.position, smooth);
          continue;
        }
        const Patches::Values value = of_corner[a](here.position);
        for (std::size_t c = 0; c < 6; ++c) smooth[c] += point.corner_share[a] * value[c];
      }
      if (part_.plane == PlaneState::stress) relax(element, here.strain), relax(element, smooth);
      energy += here.volume * energy_between(law, respond(law, here.strain), smooth);
    }
    return energy;
  }

  /// Takes off what the element would be longer by, and adds the strain that leaves no stress across the
  /// plane.
  void relax(std::size_t element, Patches::Values& strain) const {
    const double longer = free_strain_.empty() ? 0.0 : free_strain_[element];
    strain[0] -= longer, strain[1] -= longer;
    strain[2] = transverse_strain(body_.law(element), strain[0], strain[1], strain[3]);
  }

  const Part& part_;
  BodyState state_;
  Body body_;
  std::vector<double> free_strain_;
  const Cell& type_;
  bool even_;  ///< straight simplices, whose strains are the same at all points, but round an axis
  std::vector<FinePoint> points_;
  Patches patches_;
};

}  // namespace

std::vector<double> DiscretisationError::shares() const {
  std::vector<double> all = element;
  for (double& share : all) share = stored > 0.0 ? std::sqrt(share / stored) : 0.0;
  return all;
}

DiscretisationError estimate_error(const Part& part, const BodyState& state) {
  DiscretisationError error;
  error.element = Comparison(part, state).run();
  double sum = 0.0;
  for (const double one : error.element) sum += one;
  error.energy = part.node_map.sum_all(sum);
  Body body = part.body();
  body.corner_dilatation = state.corner_dilatation;
  error.stored = part.node_map.sum_all(stored_energy(body, state.u));
  if (const std::vector<double> longer = free_strain(part, state.thermal); part.plane == PlaneState::stress) {
    body.free_strain = longer;
    error.stored = std::max(error.stored, part.node_map.sum_all(stored_energy(body, state.u)));
  }
  if (error.stored > 0.0) error.relative = std::sqrt(error.energy / error.stored);
  return error;
}

std::optional<double> error_of_last(std::span<const double> values) {
  // Errors fall to a quarter with the width where nothing is known: order 2, of a smooth solution on straight
  // elements. Three numbers show how they fall; less than a half, or more than a sixteenth, is not believed.
  const std::size_t n = values.size();
  if (n < 2) return std::nullopt;
  const double last = std::abs(values[n - 1] - values[n - 2]);
  double ratio = 4.0;
  if (n > 2 && last > 0.0) ratio = std::clamp(std::abs(values[n - 2] - values[n - 3]) / last, 2.0, 16.0);
  return last / (ratio - 1.0);
}

}  // namespace kacanov
