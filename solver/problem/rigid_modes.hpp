// SPDX-License-Identifier: BSD-3-Clause
// Detects unconstrained rigid-body modes before the solve, and computes rest positions of bodies held by
// contact only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include <kacanov/problem.hpp>

namespace kacanov {

/// For every connected component of the mesh: throws InputError that names unconstrained rigid-body modes,
/// and counts in problem.loose_modes those held by contact only, with a warning. Sets problem.motions if the
/// loads of such a component can be in equilibrium (theory: rigid-balance), else problem.no_equilibrium.
void check_rigid_modes(Problem& problem);

/// Work of a force on the six rigid motions of a piece, in the order of LoosePiece::by_displacement; and the
/// Gram matrix of such rows.
using RigidRow = std::array<double, 6>;
using RigidGram = std::array<double, 36>;

/// Returns the work of a unit force along `direction` at x.
RigidRow rigid_row(const LoosePiece& piece, const Vector3& x, const Vector3& direction);

/// Returns, in words, the motions of a piece that neither its supports nor contact with this Gram matrix
/// prevent; empty if there are none.
std::string free_motions(const LoosePiece& piece, const RigidGram& by_contact, int dim, PlaneState plane);

/// Returns the displacements of these nodes by problem.motions (theory: rigid-start), nodes × dim; empty if
/// there are none.
std::vector<double> rigid_start(const Problem& problem, std::span<const std::int32_t> nodes);

/// Action of one contact point on the motions of a rigid piece: vectors with one entry per motion.
struct RigidContact {
  Eigen::VectorXd normal;                ///< along ν at the point
  std::vector<Eigen::VectorXd> tangent;  ///< along the orthonormal tangents; none without friction
  double gap = 0.0, mass = 0.0;          ///< mass: an area
  double coulomb = 0.0, tresca = 0.0;    ///< μ_f; ψ
};

/// Equilibrium of a piece's load with reactions in the friction cones of its contact points (theory:
/// rigid-balance).
struct RigidBalance {
  bool exists = true;
  Eigen::VectorXd motion;  ///< if no equilibrium exists: the motion that the load drives and no contact stops
  std::vector<std::size_t> supports;  ///< indices of the reacting points in the state closest to equilibrium
};

/// Searches for an equilibrium. `load`: work of the load on each motion; `friction`: factor on every friction
/// bound.
RigidBalance balance(const std::vector<RigidContact>& points, const Eigen::VectorXd& load,
                     double friction = 1.0);

/// Returns the factor on friction that an equilibrium needs, to six digits; infinity if none suffices.
double friction_needed(const std::vector<RigidContact>& points, const Eigen::VectorXd& load);

/// Returns the motion that brings the piece to rest on springs of `stiffness` (pressure per length) at its
/// contact points, with sticking contact (theory: rigid-start). Meaningful only if an equilibrium exists.
Eigen::VectorXd rest_on_springs(const std::vector<RigidContact>& points, const Eigen::VectorXd& load,
                                double stiffness);

}  // namespace kacanov
