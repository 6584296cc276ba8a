// SPDX-License-Identifier: BSD-3-Clause
// The solution of the same body on a coarser mesh, used as initial guess on a finer one (theory: nested).
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// The complete solution, replicated on every rank.
struct CoarseSolution {
  ElementType type = ElementType::tet4;
  std::vector<double> coordinates;     ///< nodes × dim
  std::vector<std::int32_t> elements;  ///< elements × nodes_per_element
  std::vector<double> displacement;    ///< nodes × dim
  /// Traction at a contact point.
  struct ContactTraction {
    std::int32_t node = 0, entry = 0;  ///< entry: index into Model::contact
    double pressure = 0.0;
    Vector3 friction{};
  };
  std::vector<ContactTraction> contact;  ///< ascending by node
  double lambda_max = 0.0;               ///< of the contact compliance; it hardly depends on the mesh

  /// Whether displacement and tractions are all zero: then it is no better than starting from rest.
  bool at_rest() const noexcept;
  MeshView view() const noexcept { return {type, coordinates, elements}; }
};

/// Gathers the solution of a part's problem and replicates it on all ranks. `problem` is the complete problem
/// on rank 0 (before keep_boundary()) and null elsewhere. Collective.
CoarseSolution whole_solution(const Part& part, const Problem* problem, const Solution& solution);

/// Broadcasts `coarse` from rank 0. Collective.
void share(CoarseSolution& coarse, const Communicator& ranks);

/// Initial guess: values at the nodes and contact points of one part; every copy of a shared entry has the
/// same bits.
struct Start {
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double> pressure;      ///< contact points
  std::vector<double> friction;      ///< contact points × 2: along the tangents
  double lambda_max = 0.0;           ///< as in CoarseSolution
};

/// Interpolates displacements with the shape functions of the coarse element that contains each node, and
/// tractions by the mean over the element's nodes in contact, weighted with the same shape functions. Nodes
/// outside the coarse body, e.g. on a finer boundary, use the nearest element. Not collective.
Start interpolate(const CoarseSolution& coarse, const Part& part);

}  // namespace kacanov
