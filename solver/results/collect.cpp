// SPDX-License-Identifier: BSD-3-Clause
// Collects contact fields and totals of the whole body in a result.
#include "results/collect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <kacanov/element_fields.hpp>
#include "partition/global_max.hpp"
#include "problem/rigid_modes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Returns the friction traction of the obstacle on the body at a point.
Vector3 traction_of(const ContactPoint& point, const double* friction) {
  Vector3 traction{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
    for (std::size_t c = 0; c < 3; ++c) traction[c] -= friction[k] * point.tangent[k][c];
  return traction;
}

ContactStatus status_of(const ContactPoint& point, const ContactState& state, std::size_t i,
                        double least_slip) {
  const double *friction = &state.lambda.tangential[2 * i], *slip = &state.trace.tangential[2 * i];
  // The projection gives |λ_t| = ψ up to rounding at slipping points, but Coulomb's ψ has been updated since,
  // within the solver's tolerance.
  const bool slips = point.tangents == 0 ||
                     std::hypot(friction[0], friction[1]) >= state.bound[i] * (1.0 - 1e-10) ||
                     std::hypot(slip[0], slip[1]) > least_slip;
  const bool touches = state.lambda.normal[i] > 0.0;
  if (!touches && (point.tangents == 0 || state.bound[i] == 0.0)) return ContactStatus::open;
  return slips ? ContactStatus::slip : ContactStatus::stick;
}

void collect_contact_totals(const Part& part, Solution& solution) {
  Result& result = solution.result;
  std::array<double, 8> sums{};  // contact force, friction force, active, slip
  double pressure = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i) {
    const auto& point = part.contact[i];
    for (const RowEntry& entry : part.contact.entries(i))
      for (std::size_t c = 0; c < 3; ++c) sums[c] -= point.mass * solution.pressure[i] * entry.trace[c];
    for (std::size_t c = 0; c < 3; ++c) sums[3 + c] += point.mass * solution.traction[i][c];
    sums[6] += solution.pressure[i] > 0.0 ? 1.0 : 0.0;
    sums[7] += point.tangents > 0 && solution.contact_status[i] == ContactStatus::slip ? 1.0 : 0.0;
    pressure = std::max(pressure, solution.pressure[i]);
  }
  part.node_map.sum_all(sums);
  for (std::size_t c = 0; c < 3; ++c) {
    result.contact_force[c] = sums[c];
    result.friction_force[c] = sums[3 + c];
  }
  result.active_nodes = std::llround(sums[6]);
  result.slip_nodes = std::llround(sums[7]);
  result.max_contact_pressure = part.node_map.max_all(pressure);
}

void collect_probes(const Part& part, std::span<const double> u, Result& result) {
  const std::size_t dim = part.dim();
  const std::size_t npe = nodes_per_element(part.type);
  std::vector<double> all(3 * static_cast<std::size_t>(part.total_probes), 0.0);
  for (std::size_t i = 0; i < part.probes.size(); ++i) {
    const auto* node = &part.elements[static_cast<std::size_t>(part.probes[i].element) * npe];
    double* to = &all[3 * static_cast<std::size_t>(part.probe_index[i])];
    for (std::size_t a = 0; a < npe; ++a)
      for (std::size_t c = 0; c < dim; ++c)
        to[c] += part.probes[i].weights[a] * u[static_cast<std::size_t>(node[a]) * dim + c];
  }
  part.node_map.sum_all(all);
  result.probe.clear();
  for (std::size_t i = 0; i < all.size(); i += 3) result.probe.push_back({all[i], all[i + 1], all[i + 2]});
}

}  // namespace

void collect_contact(const Part& part, const ContactState& state, double tolerance, Solution& solution) {
  double moved = 0.0;
  for (const double v : state.u) moved = std::max(moved, std::abs(v));
  const double least_slip = 10.0 * tolerance * part.node_map.max_all(moved);
  solution.pressure = state.lambda.normal;
  solution.gap = state.gap;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    solution.gap[i] -= state.trace.normal[i];
    solution.traction.push_back(traction_of(part.contact[i], &state.lambda.tangential[2 * i]));
    solution.contact_status.push_back(status_of(part.contact[i], state, i, least_slip));
  }
}

void FreeMotions::look(const Part& part, const ContactState& state, double tolerance,
                       const std::string& place) {
  const std::vector<LoosePiece>& pieces = part.loose_pieces;
  if (pieces.empty()) return;
  largest_.resize(pieces.size());
  first_.resize(pieces.size());
  const auto points = static_cast<std::size_t>(part.owned_contact);
  const auto piece_of = [&](std::size_t i) { return part.contact[i].loose_piece; };
  for (std::size_t i = 0; i < points; ++i)
    if (piece_of(i) >= 0)
      largest_[piece_of(i)] = std::max(largest_[piece_of(i)], part.contact[i].mass * state.lambda.normal[i]);
  part.node_map.max_all(largest_);
  std::vector<RigidGram> grams(pieces.size());
  for (std::size_t i = 0; i < points; ++i) {
    if (piece_of(i) < 0) continue;
    const double force = part.contact[i].mass * state.lambda.normal[i];
    const bool presses = force > tolerance * largest_[piece_of(i)];
    const auto add = [&](const auto& direction) {
      RigidRow sum{};
      for (const RowEntry& entry : part.contact.entries(i)) {
        const RigidRow row =
            rigid_row(pieces[piece_of(i)], node_position(part, entry.node), direction(entry));
        for (std::size_t m = 0; m < 6; ++m) sum[m] += row[m];
      }
      for (std::size_t m = 0; m < 36; ++m) grams[piece_of(i)][m] += sum[m / 6] * sum[m % 6];
    };
    if (presses) add([](const RowEntry& entry) -> const Vector3& { return entry.normal; });
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.contact[i].tangents); ++k)
      if (presses || part.contact[i].tresca > 0.0)
        add([k](const RowEntry& entry) -> const Vector3& { return entry.tangent[k]; });
  }
  part.node_map.sum_all(std::span(grams.front().data(), 36 * grams.size()));
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (!first_[k].empty()) continue;
    const std::string motions = free_motions(pieces[k], grams[k], part.dim(), part.plane);
    if (motions.empty()) continue;
    first_[k] = (place.empty() ? "" : place + ": ") + "the contact that holds " + pieces[k].name +
                " leaves it free to move (" + motions +
                "). Forces and stresses are right. The place where it rests is one of many";
  }
}

std::vector<std::string> FreeMotions::warnings() const {
  std::vector<std::string> all;
  for (const std::string& warning : first_)
    if (!warning.empty()) all.push_back(warning);
  return all;
}

void collect_totals(const Part& part, const ContactState& state, Solution& solution) {
  collect_contact_totals(part, solution);
  collect_body_totals(part, {state.u, solution.thermal, solution.corner_dilatation}, solution.result);
  collect_probes(part, state.u, solution.result);
}

namespace {

Extreme largest_displacement(const Part& part, std::span<const double> u) {
  const std::size_t dim = part.dim();
  GlobalMax here;
  for (std::size_t n = 0; n < static_cast<std::size_t>(part.owned_nodes()); ++n) {
    double square = 0.0;
    for (std::size_t c = 0; c < dim; ++c) square += u[n * dim + c] * u[n * dim + c];
    here.take(std::sqrt(square), n, part.node_index[n]);
  }
  return agree_on_node(part, here);
}

BodySize size_of_body(const Part& part, double volume) {
  constexpr double none = -std::numeric_limits<double>::max();
  std::array<double, 6> reach{none, none, none, none, none, none};  // upper corner, negated lower corner
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
  GlobalMax strain, rotation, flow;
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
