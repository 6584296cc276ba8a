// SPDX-License-Identifier: BSD-3-Clause
// Builds contact rows: nodes that face an obstacle, with normal, gap and mass (theory: traces, contact-mass).
#include <algorithm>
#include <map>

#include "verify/load_point.hpp"
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

/// Pose of a moved rigid obstacle (theory: moving-obstacles).
struct Pose {
  Vec centre{}, shift{}, turn{};

  /// Returns (R − 1) v.
  Vec swept(const Vec& v, Real sign = 1) const {
    const Real angle = norm(turn);
    if (!(angle > 0)) return {};
    const Vec axis = 1 / angle * turn, across = cross(axis, v);
    return sign * std::sin(angle) * across + (1 - std::cos(angle)) * cross(axis, across);
  }
  /// Displacement of a point of the obstacle.
  Vec carried(const Vec& point) const { return shift + swept(point - centre); }
  Vec turned(const Vec& v) const { return v + swept(v); }
  Vec turned_back(const Vec& v) const { return v + swept(v, -1); }
  /// Maps a point y of the moved obstacle back to its initial position.
  Vec back(const Vec& y) const { return centre + turned_back(y - shift - centre); }
};

/// Returns the pose of a motion at a time; at rest without a motion.
Pose pose_at(const nlohmann::json& entry, Real time) {
  if (!entry.contains("motion")) return {};
  const nlohmann::json& motion = entry.at("motion");
  Real from = 0;
  Pose pose;
  Vec &shift = pose.shift, &turn = pose.turn;
  for (const auto& next_pose : motion.at("path")) {
    const Real to = next_pose.at("time").get<double>();
    const Vec next = next_pose.contains("translation") ? read_vector(next_pose.at("translation")) : Vec{};
    Vec angle{};
    if (next_pose.contains("rotation")) {
      const nlohmann::json& rotation = next_pose.at("rotation");
      angle = rotation.is_number() ? Vec{0, 0, rotation.get<double>()} : read_vector(rotation);
    }
    const Real share = std::min((time - from) / (to - from), Real(1));
    if (share < 0) break;
    shift = shift + share * (next - shift);
    turn = turn + share * (angle - turn);
    from = to;
  }
  if (motion.contains("centre")) pose.centre = read_vector(motion.at("centre"));
  return pose;
}

/// Joins a row to one of the same node with the same normal and gap.
bool joined(std::vector<ContactRow>& rows, const ContactRow& row, Real size) {
  for (ContactRow& twin : rows) {
    if (twin.alone || (twin.friction && row.friction && twin.since_step != row.since_step)) continue;
    if (norm(twin.normal - row.normal) >= 1e-9L || std::abs(twin.gap - row.gap) >= 1e-9L * size) continue;
    const Real mass = twin.mass + row.mass;
    twin.unknown_gap = larger(twin.unknown_gap, row.unknown_gap) + std::abs(twin.gap - row.gap);
    twin.gap = std::min(twin.gap, row.gap);
    twin.tresca = (twin.mass * twin.tresca + row.mass * row.tresca) / mass;
    twin.coulomb = (twin.mass * twin.coulomb + row.mass * row.coulomb) / mass;
    if (!twin.friction) {
      twin.friction = row.friction;
      twin.since_step = row.since_step;
      twin.slip_origin = row.slip_origin;
    }
    twin.mass = mass;
    twin.written.insert(twin.written.end(), row.written.begin(), row.written.end());
    twin.parts.insert(twin.parts.end(), row.parts.begin(), row.parts.end());
    return true;
  }
  return false;
}

/// A contact entry: its obstacle, with the poses at the start and end of the load step.
struct Obstacle {
  Obstacle(const nlohmann::json& contact, std::size_t number, const std::filesystem::path& folder,
           const Problem& problem)
      : entry(contact.at(number)),
        face(read_obstacle(entry.at("obstacle"), folder)),
        pushed(entry.contains("force_controlled")),
        anew(entry.value("relinearise", false)),
        withdrawn(pushed && !(problem.contact_factor[number] > 0)),
        since_step(counts_from_step(entry)),
        start(pose_at(entry, problem.point.begin)),
        now(pose_at(entry, problem.point.end)) {
    if (!pushed) return;
    const Vec way = read_vector(entry.at("force_controlled").at("direction"));
    const Real travel = problem.point.travel[number], before = problem.point.travel_before[number];
    start.shift = now.shift = before / norm(way) * way;
    further = (travel - before) / norm(way) * way;
  }
  bool moves() const { return entry.contains("motion") || pushed || anew; }

  const nlohmann::json& entry;
  Face face;
  bool pushed, anew, withdrawn, since_step;
  Pose start, now;
  Vec further{};  ///< additional travel in this load step
};

/// Updates a row from the obstacle's initial position to its current one, with the node where the previous
/// load step left it. Returns false if the node does not face the obstacle.
bool follow(const Obstacle& obstacle, Facing facing, const Vec& x, const Vec& before, ContactRow& row) {
  if (obstacle.withdrawn) return false;
  Vec seen = x;
  if (obstacle.anew) {
    seen = obstacle.now.back(x + before);
    facing = obstacle.face(seen, obstacle.now.turned_back(row.normal));
  }
  if (facing.missed) return false;
  const Vec foot = seen + facing.gap * facing.normal;
  const Vec carried = obstacle.now.carried(foot), since = carried - obstacle.start.carried(foot);
  row.unknown_gap = facing.unknown + 1e-15L * (norm(carried) + norm(obstacle.further));
  row.normal = facing.normal;
  row.grazing = facing.grazing;
  row.gap = facing.gap;
  if (obstacle.anew) {
    row.unknown_gap += 1e-15L * (norm(x) + norm(before) + norm(obstacle.now.centre));
    row.normal = obstacle.now.turned(facing.normal);
    row.gap += dot(row.normal, before);
  } else {
    row.gap += dot(row.normal, carried);
  }
  row.gap += dot(row.normal, obstacle.further);
  row.slip_origin = (obstacle.since_step ? before + since : carried) + obstacle.further;
  return true;
}

/// Longest side of the bounding box of the nodes.
Real longest_side(const Mesh& mesh) {
  Vec low = mesh.nodes.at(0), high = low;
  Real longest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const Vec& x : mesh.nodes) {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
    longest = larger(longest, high[c] - low[c]);
  }
  return longest;
}

/// Restricts the row to free components, and records the part of the gap closed by prescribed ones; false if
/// none are free.
bool restrict_to_free(const Problem& problem, ContactRow& row) {
  const auto node = static_cast<std::size_t>(row.node);
  row.closed = 0;
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
  const Real size = mesh.size(), far = 10 * longest_side(mesh);
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
    const Obstacle obstacle(contact, number, folder, problem);
    for (const auto& [node, sum] : sums) {
      ContactRow row;
      row.node = node;
      row.entry = number;
      row.written = {problem.surface_tags.size()};
      problem.surface_tags.push_back(mesh.tags[node]);
      if (!(sum.mass > 0)) continue;
      const Vec before = problem.point.before.empty() ? Vec{} : problem.point.before[node];
      const Facing facing = obstacle.face(mesh.nodes[node], sum.outer);
      // A node that misses the obstacle initially may face it in a later load step.
      if (facing.missed && !(obstacle.anew && norm(sum.outer) > 0)) continue;
      row.normal = facing.missed ? 1 / norm(sum.outer) * sum.outer : facing.normal;
      row.gap = facing.gap;
      row.unknown_gap = facing.unknown;
      row.grazing = facing.grazing;
      row.since_step = obstacle.since_step;
      if (row.since_step) row.slip_origin = before;
      row.mass = sum.mass;
      row.parts = {{number, sum.mass}};
      row.tresca = friction.value("tresca", 0.0);
      row.coulomb = friction.value("coulomb", 0.0);
      row.friction = row.tresca > 0 || row.coulomb > 0;
      if (!restrict_to_free(problem, row)) continue;
      row.alone = obstacle.moves();
      if (row.alone) {
        ContactRow now = row;
        if (follow(obstacle, facing, mesh.nodes[node], before, now) && restrict_to_free(problem, now)) {
          row = now;
        } else {
          row.gap = far;
          row.tresca = 0;
        }
      }
      if (row.alone || !joined(rows[node], row, size)) rows[node].push_back(row);
    }
  }
  // With a contact factor below 1, add the missing share of the deepest initial penetration to the gap.
  std::vector<Real> depth(problem.contact_factor.size());
  for (auto& [node, of_node] : rows)
    for (ContactRow& row : of_node) {
      if (!row.alone) depth[row.entry] = larger(depth[row.entry], -row.gap);
      problem.rows.push_back(std::move(row));
    }
  for (ContactRow& row : problem.rows)
    row.gap += (1 - problem.contact_factor[row.entry]) * depth[row.entry] - row.closed;
}

}  // namespace kacanov::verify
