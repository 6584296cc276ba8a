// SPDX-License-Identifier: BSD-3-Clause
// The solution of the same body on a coarser mesh, to start a finer one from (theory: nested).
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Whole, on every rank.
struct CoarseSolution {
  ElementType type = ElementType::tet4;
  std::vector<double> coordinates;     ///< nodes × dim
  std::vector<std::int32_t> elements;  ///< elements × nodes_per_element
  std::vector<double> displacement;    ///< nodes × dim
  /// Traction of a contact point.
  struct ContactTraction {
    std::int32_t node = 0, entry = 0;  ///< entry: index into Model::contact
    double pressure = 0.0;
    Vector3 friction{};
  };
  std::vector<ContactTraction> contact;  ///< ascending by node
  double lambda_max = 0.0;               ///< of the contact compliance, which the mesh hardly changes

  /// Whether nothing has moved and nothing bears: no better a start than none.
  bool at_rest() const noexcept;
  MeshView view() const noexcept { return {type, coordinates, elements}; }
};

/// Collects the solution of a part's problem, which rank 0 has whole (null elsewhere; before
/// keep_boundary()). Collective.
CoarseSolution whole_solution(const Part& part, const Problem* problem, const Solution& solution);

/// Hands the one that rank 0 has to all others. Collective.
void share(CoarseSolution& coarse, const Communicator& ranks);

/// What a run starts from instead of rest: values at the nodes and contact points of one part, every copy of
/// a shared entry with the same bits.
struct Start {
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double> pressure;      ///< contact points
  std::vector<double> friction;      ///< contact points × 2: along the tangents
  double lambda_max = 0.0;           ///< as in CoarseSolution
};

/// Interpolates by the shape functions of the coarse elements that nodes lie in, tractions by the mean of the
/// nodes that bear contact, weighed with them. Nodes outside the coarse body, as a finer boundary leaves
/// some, take what the nearest element says there. Not collective.
Start interpolate(const CoarseSolution& coarse, const Part& part);

}  // namespace kacanov
