// SPDX-License-Identifier: BSD-3-Clause
// Mesh, laws, boundary conditions and contact, validated once, then trusted.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// One node facing an obstacle: the constraint ν·ω ≤ gap and, with friction, the tangential trace.
struct ContactPoint {
  std::int32_t node = 0;
  std::int32_t entry = 0;            ///< index into Model::contact
  Vector3 normal{};                  ///< ν, unit, from the body towards the obstacle
  Vector3 trace{};                   ///< ν restricted to the components that are not held: row of N
  std::array<Vector3, 2> tangent{};  ///< orthonormal rows of T; `tangents` of them
  int tangents = 0;                  ///< 0 without friction or where all tangential components are held
  double gap = 0.0;                  ///< ρ
  double mass = 0.0;                 ///< lumped contact mass M, an area (a length in 2D)
  double tresca = 0.0;               ///< ψ
  double coulomb = 0.0;              ///< μ_f
};

struct Probe {
  Vector3 point{};
  std::int32_t element = 0;
  std::array<double, 10> weights{};  ///< shape functions at the point
};

/// The whole problem, on one rank.
struct Problem {
  Mesh mesh;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;
  std::vector<double> load;        ///< F: nodes × dim
  std::vector<std::uint8_t> held;  ///< nodes × dim: 1 where the displacement is given
  std::vector<double> prescribed;  ///< nodes × dim: its value
  std::vector<ContactPoint> contact;
  std::vector<Probe> probes;
  int loose_modes = 0;  ///< rigid modes that only the contact holds
  std::vector<std::string> warnings;
};

/// Frees what only the parts need once they are made: the arrays over nodes and elements, and in 3D the
/// elements and inner nodes themselves. What is left serves pictures and output: the boundary, contact
/// points, named facets; nodes are renumbered. Returns the former number of each node that is left.
std::vector<std::int32_t> keep_boundary(Problem& problem);

/// Resolves every `on`, assembles the load, finds traces and gaps. Throws InputError in the words of the case
/// file ("boundary[1].on: ..."): unknown names with those that exist, empty selections, contact
/// without facets, materials that overlap or leave elements without one, rigid modes that nothing
/// holds, probes outside the body.
Problem build_problem(Mesh mesh, const Model& model);

}  // namespace kacanov
