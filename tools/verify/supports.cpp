// SPDX-License-Identifier: BSD-3-Clause
// Given displacements, by component and along directions.
#include "verify/problem.hpp"

namespace kacanov::verify {
namespace {

void hold_along(Problem& problem, Index node, const Vec& direction, Real value) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(direction[c]) < 1 - 1e-12L) continue;
    problem.held[node][c] = true;
    problem.prescribed[node][c] = direction[c] > 0 ? value : -value;
    return;
  }
  problem.directions[node].push_back({direction, value});
}

}  // namespace

void hold(Problem& problem, const nlohmann::json& entry, Real factor) {
  const Mesh& mesh = problem.mesh;
  std::vector<GivenDirection> given;
  if (entry.contains("normal")) {
    Vec sum{};
    for (const std::size_t f : select_facets(mesh, entry.at("on")))
      for (const Vec& share : consistent(mesh, mesh.facets[f]).normal) sum = sum + share;
    given.push_back({1 / norm(sum) * sum, factor * Real(entry.at("normal").get<double>())});
  } else {
    const nlohmann::json& values = entry.at("displacement");
    for (std::size_t c = 0; c < static_cast<std::size_t>(mesh.dim()); ++c) {
      if (values.at(c).is_null()) continue;
      Vec axis{};
      axis[c] = 1;
      if (entry.contains("frame")) {
        axis = read_vector(entry.at("frame").at(c));
        axis = 1 / norm(axis) * axis;
      }
      given.push_back({axis, factor * Real(values.at(c).get<double>())});
    }
  }
  for (const Index node : select_nodes(mesh, entry.at("on")))
    for (const GivenDirection& one : given) hold_along(problem, node, one.direction, one.value);
}

void find_directions(Problem& problem) {
  for (auto& [node, raw] : problem.directions) {
    std::vector<GivenDirection> kept;
    for (GivenDirection one : raw) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (!problem.held[node][c]) continue;
        one.value -= one.direction[c] * problem.prescribed[node][c];
        one.direction[c] = 0;
      }
      for (int pass = 0; pass < 2; ++pass)
        for (const GivenDirection& other : kept) {
          const Real share = dot(one.direction, other.direction);
          one.value -= share * other.value;
          one.direction = one.direction - share * other.direction;
        }
      const Real rest = norm(one.direction);
      if (rest < 1e-8L) continue;
      kept.push_back({1 / rest * one.direction, one.value / rest});
    }
    raw = kept;
  }
}

Vec free_part(const Problem& problem, Index node, Vec v) {
  for (std::size_t c = 0; c < 3; ++c)
    if (problem.held[node][c]) v[c] = 0;
  const auto there = problem.directions.find(node);
  if (there == problem.directions.end()) return v;
  for (const GivenDirection& one : there->second) v = v - dot(one.direction, v) * one.direction;
  return v;
}

}  // namespace kacanov::verify
