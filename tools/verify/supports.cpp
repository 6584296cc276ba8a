// SPDX-License-Identifier: BSD-3-Clause
// Prescribed displacements, by component and along directions.
#include <limits>

#include "verify/problem.hpp"

namespace kacanov::verify {
namespace {

/// A direction with a smaller component orthogonal to the others of its node counts as dependent on them.
constexpr Real dependent_below = 1e-8L;

void hold_along(Problem& problem, Index node, GivenSupport given) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(given.direction[c]) < 1 - 1e-12L) continue;
    const Real sign = given.direction[c] > 0 ? 1 : -1;
    given.axis = true;
    given.direction = {};
    given.direction[c] = sign;
    problem.held[node][c] = true;
    problem.prescribed[node][c] = sign * given.value;
    break;
  }
  problem.supports[node].push_back(given);
}

}  // namespace

void hold(Problem& problem, const nlohmann::json& entry, std::size_t number, const Factor& factor) {
  const Mesh& mesh = problem.mesh;
  std::vector<GivenSupport> given;
  const auto give = [&](const Vec& direction, Real value) {
    given.push_back({direction, number, factor.value * value, factor.largest * std::abs(value)});
    // The program computes facet normals in double precision.
    if (entry.contains("normal"))
      given.back().condition =
          16 * std::numeric_limits<double>::epsilon() / std::numeric_limits<Real>::epsilon();
  };
  if (entry.contains("normal")) {
    Vec sum{};
    for (const std::size_t f : select_facets(mesh, entry.at("on")))
      for (const Vec& share : consistent(mesh, mesh.facets[f]).normal) sum = sum + share;
    give(1 / norm(sum) * sum, entry.at("normal").get<double>());
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
      give(axis, values.at(c).get<double>());
    }
  }
  for (const Index node : select_nodes(mesh, entry.at("on")))
    for (const GivenSupport& one : given) hold_along(problem, node, one);
}

void find_directions(Problem& problem) {
  for (auto& [node, supports] : problem.supports) {
    std::vector<GivenDirection> kept;
    for (GivenSupport& given : supports) {
      if (given.axis) continue;
      GivenDirection one{given.direction, given.value, given.entry};
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
      given.dependent = rest < dependent_below;
      Real condition = given.condition;
      for (const GivenDirection& other : kept) condition += other.condition;
      if (!given.dependent)
        kept.push_back({1 / rest * one.direction, one.value / rest, one.entry, condition / rest});
    }
    if (!kept.empty()) problem.directions[node] = kept;
  }
}

Real off_supports(const std::vector<GivenSupport>& supports, const Vec& u, Real most) {
  constexpr Real epsilon = std::numeric_limits<double>::epsilon() / 2;
  const auto count = static_cast<Real>(supports.size());
  // A correction step of the solver leaves an error along the directions that is below the last term.
  const Real moved = norm(u) + std::sqrt(epsilon) * most;
  Real farthest = 0;
  for (const GivenSupport& given : supports) {
    const Real size = moved + std::abs(given.value);
    Real unknown = 8 * epsilon * given.largest;
    if (!given.axis) unknown += 16 * count * epsilon * size;
    if (given.dependent) unknown += dependent_below * moved + 1e-6L * size;
    const Real off = std::abs(dot(given.direction, u) - given.value);
    if (!(off <= unknown)) farthest = larger(farthest, off);
  }
  return farthest;
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
