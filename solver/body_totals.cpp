// SPDX-License-Identifier: BSD-3-Clause
// The extremes of a body's displacement, strain and stress with their places, and its size.
#include "body_totals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <kacanov/element_fields.hpp>
#include "largest.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

Extreme largest_displacement(const Part& part, std::span<const double> u) {
  const std::size_t dim = part.dim();
  Largest here;
  for (std::size_t n = 0; n < static_cast<std::size_t>(part.owned_nodes()); ++n) {
    double square = 0.0;
    for (std::size_t c = 0; c < dim; ++c) square += u[n * dim + c] * u[n * dim + c];
    here.take(std::sqrt(square), n, part.node_index[n]);
  }
  return agree_on_node(part, here);
}

BodySize size_of_body(const Part& part, double volume) {
  constexpr double none = -std::numeric_limits<double>::max();
  std::array<double, 6> reach{none, none, none, none, none, none};  // upper corner, lower corner negated
  for (std::size_t n = 0; n < part.nodes(); ++n) {
    const Vector3 x = node_position(part, n);
    for (std::size_t c = 0; c < 3; ++c) {
      reach[c] = std::max(reach[c], x[c]);
      reach[3 + c] = std::max(reach[3 + c], -x[c]);
    }
  }
  part.node_map.max_all(reach);
  BodySize body;
  body.dim = part.dim();
  body.upper = {reach[0], reach[1], reach[2]};
  body.lower = {-reach[3], -reach[4], -reach[5]};
  body.size = norm(body.upper - body.lower);
  body.volume = volume;
  return body;
}

}  // namespace

void collect_body_totals(const Part& part, const BodyState& state, Result& result) {
  std::int64_t plastic = 0, softening = 0;
  double von_mises = 0.0;
  std::array<double, 2> volumes{};  // all, beyond yield
  Largest strain, rotation, flow;
  const Body body = part.body();
  visit_element_fields(part, state, [&](const ElementRun& run) {
    for (std::size_t e = 0; e < run.plastic.size(); ++e) {
      const std::int32_t index = part.element_index[run.first + e];
      plastic += run.plastic[e];
      volumes[0] += run.volume[e];
      volumes[1] += run.plastic[e] != 0 ? run.volume[e] : 0.0;
      von_mises = std::max(von_mises, run.von_mises[e]);
      if (const double proof = body.law(run.first + e).proof_strain(); std::isfinite(proof))
        flow.take(run.dev_strain[e] / proof, run.first + e, index);
      softening += body.law(run.first + e).softens(run.dev_strain[e]) ? 1 : 0;
      strain.take(run.strain[e], run.first + e, index);
      rotation.take(run.rotation[e], run.first + e, index);
    }
  });
  part.node_map.sum_all(volumes);
  result.element = part.type;
  result.plastic_elements = part.node_map.sum_all(plastic);
  result.softening_elements = part.node_map.sum_all(softening);
  result.max_von_mises = part.node_map.max_all(von_mises);
  result.plastic_share = volumes[1] / volumes[0];
  result.max_strain = agree_on_element(part, strain);
  result.max_flow = agree_on_element(part, flow);
  result.max_rotation = agree_on_element(part, rotation);
  result.max_displacement = largest_displacement(part, state.u);
  result.body = size_of_body(part, volumes[0]);
}

}  // namespace kacanov
