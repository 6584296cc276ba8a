// SPDX-License-Identifier: BSD-3-Clause
// Contact rows: who faces an obstacle, along which direction, at what distance (theory: traces,
// contact-mass).
#include <algorithm>
#include <map>

#include "verify/obstacle.hpp"
#include "verify/problem.hpp"

namespace kacanov::verify {

FacetIntegrals contact_weights(const Mesh& mesh, const Indices& facet) {
  if (facet_shape(mesh.shape) != Shape::tri6) return consistent(mesh, facet);
  FacetIntegrals out{std::vector<Real>(6), std::vector<Vec>(6)};
  const Real half = Real(1) / 2;
  const std::array<Vec, 3> middles{{{half, 0, 0}, {half, half, 0}, {0, half, 0}}};
  for (std::size_t k = 0; k < 3; ++k) {
    out.normal[k + 3] = Real(1) / 6 * normal_at(mesh, facet, functions(Shape::tri6, middles[k]));
    out.area[k + 3] = norm(out.normal[k + 3]);
  }
  return out;
}

namespace {

/// How far a point of an obstacle has come by a time (theory: moving-obstacles).
Vec carried(const nlohmann::json& entry, Real time, const Vec& point) {
  if (!entry.contains("motion")) return {};
  const nlohmann::json& motion = entry.at("motion");
  Real from = 0;
  Vec shift{}, turn{};
  for (const auto& pose : motion.at("path")) {
    const Real to = pose.at("time").get<double>();
    const Vec next = pose.contains("translation") ? read_vector(pose.at("translation")) : Vec{};
    Vec angle{};
    if (pose.contains("rotation")) {
      const nlohmann::json& rotation = pose.at("rotation");
      angle = rotation.is_number() ? Vec{0, 0, rotation.get<double>()} : read_vector(rotation);
    }
    const Real share = std::min((time - from) / (to - from), Real(1));
    if (share < 0) break;
    shift = shift + share * (next - shift);
    turn = turn + share * (angle - turn);
    from = to;
  }
  const Vec centre = motion.contains("centre") ? read_vector(motion.at("centre")) : Vec{};
  const Vec arm = point - centre;
  const Real angle = norm(turn);
  if (!(angle > 0)) return shift;
  const Vec axis = 1 / angle * turn, across = cross(axis, arm);
  return shift + std::sin(angle) * across + (1 - std::cos(angle)) * cross(axis, across);
}

/// Joins a row to one of the same node that faces the same way at the same gap.
bool joined(std::vector<ContactRow>& rows, const ContactRow& row, Real size) {
  for (ContactRow& twin : rows) {
    if (twin.alone || norm(twin.normal - row.normal) >= 1e-9L || std::abs(twin.gap - row.gap) >= 1e-9L * size)
      continue;
    const Real mass = twin.mass + row.mass;
    twin.unknown_gap = larger(twin.unknown_gap, row.unknown_gap) + std::abs(twin.gap - row.gap);
    twin.gap = std::min(twin.gap, row.gap);
    twin.tresca = (twin.mass * twin.tresca + row.mass * row.tresca) / mass;
    twin.coulomb = (twin.mass * twin.coulomb + row.mass * row.coulomb) / mass;
    twin.friction = twin.friction || row.friction;
    twin.mass = mass;
    twin.written.insert(twin.written.end(), row.written.begin(), row.written.end());
    twin.parts.insert(twin.parts.end(), row.parts.begin(), row.parts.end());
    return true;
  }
  return false;
}

/// Leaves the free components in the row and takes from the gap what prescribed ones close; false where none
/// are left.
bool restrict_to_free(const Problem& problem, ContactRow& row) {
  const auto node = static_cast<std::size_t>(row.node);
  for (std::size_t c = 0; c < 3; ++c)
    if (problem.held[node][c]) row.closed += row.normal[c] * problem.prescribed[node][c];
  if (const auto there = problem.directions.find(row.node); there != problem.directions.end())
    for (const GivenDirection& one : there->second) row.closed += dot(row.normal, one.direction) * one.value;
  const Vec free = free_part(problem, row.node, row.normal);
  row.shares = {{row.node, free}};
  return norm(free) >= 1e-8L;
}

}  // namespace

void find_rows(const nlohmann::json& contact, const std::filesystem::path& folder, Problem& problem) {
  const Mesh& mesh = problem.mesh;
  const Real size = mesh.size();
  std::map<Index, std::vector<ContactRow>> rows;
  for (std::size_t number = 0; number < contact.size(); ++number) {
    const nlohmann::json& entry = contact.at(number);
    struct Sums {
      Real mass = 0;
      Vec outer{};
    };
    std::map<Index, Sums> sums;
    for (const std::size_t f : select_facets(mesh, entry.at("on"))) {
      const FacetIntegrals weights = contact_weights(mesh, mesh.facets[f]);
      for (std::size_t k = 0; k < mesh.facets[f].size(); ++k) {
        Sums& sum = sums[mesh.facets[f][k]];
        sum.mass += weights.area[k];
        sum.outer = sum.outer + weights.normal[k];
      }
    }
    const nlohmann::json friction = entry.value("friction", nlohmann::json::object());
    if (friction.value("reference", "start") != "start")
      throw Failure("contact[" + std::to_string(number) +
                    "].friction.reference: slip counts from the end of a load "
                    "step that no file holds, so that the verifier cannot tell it");
    const Face face = read_obstacle(entry.at("obstacle"), folder);
    if (entry.value("relinearise", false))
      throw Failure("contact[" + std::to_string(number) +
                    "].relinearise: nodes face the obstacle from where the load step before has left them, "
                    "which no file holds");
    const bool moves = entry.contains("motion") || entry.contains("force_controlled");
    for (const auto& [node, sum] : sums) {
      ContactRow row;
      row.node = node;
      row.entry = number;
      row.written = {problem.surface_tags.size()};
      problem.surface_tags.push_back(mesh.tags[node]);
      if (!(sum.mass > 0)) continue;
      const Facing facing = face(mesh.nodes[node], sum.outer);
      if (facing.missed) continue;
      row.normal = facing.normal;
      row.gap = facing.gap;
      row.carried = carried(entry, problem.time, mesh.nodes[node] + facing.gap * facing.normal) +
                    problem.pushed[number];
      row.gap += dot(row.normal, row.carried);
      row.unknown_gap = facing.unknown + 1e-15L * norm(row.carried);
      row.grazing = facing.grazing;
      row.mass = sum.mass;
      row.parts = {{number, sum.mass}};
      row.tresca = friction.value("tresca", 0.0);
      row.coulomb = friction.value("coulomb", 0.0);
      row.friction = row.tresca > 0 || row.coulomb > 0;
      if (!restrict_to_free(problem, row)) continue;
      row.alone = moves;
      if (moves || !joined(rows[node], row, size)) rows[node].push_back(row);
    }
  }
  // Where an obstacle presses in, the share of its deepest indentation that is lacking.
  std::vector<Real> depth(problem.contact_factor.size());
  for (auto& [node, of_node] : rows)
    for (ContactRow& row : of_node) {
      if (!contact.at(row.entry).contains("motion") && !contact.at(row.entry).contains("force_controlled"))
        depth[row.entry] = larger(depth[row.entry], -row.gap);
      problem.rows.push_back(std::move(row));
    }
  for (ContactRow& row : problem.rows)
    row.gap += (1 - problem.contact_factor[row.entry]) * depth[row.entry] - row.closed;
}

}  // namespace kacanov::verify
