// SPDX-License-Identifier: BSD-3-Clause
// Which rigid motions nothing holds, found before the solver meets them, and where contact brings such a body
// to rest.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include <kacanov/problem.hpp>

namespace kacanov {

/// For every connected piece of the mesh: throws InputError naming the rigid motions that neither
/// displacements nor contact hold; counts in problem.loose_modes those that the contact alone holds, with a
/// warning.
/// Where the loads of what contact alone holds can be in balance (theory: rigid-balance) it sets
/// problem.motions, else problem.no_equilibrium.
void check_rigid_modes(Problem& problem);

/// Displacements of these nodes by problem.motions (theory: rigid-start), nodes × dim; empty without any.
std::vector<double> rigid_start(const Problem& problem, std::span<const std::int32_t> nodes);

/// What one contact point does on the motions of a rigid piece, as many rows as it has motions.
struct RigidContact {
  Eigen::VectorXd normal;                ///< ν at the point
  std::vector<Eigen::VectorXd> tangent;  ///< orthonormal tangents; none without friction
  double gap = 0.0, mass = 0.0;          ///< mass: an area
  double coulomb = 0.0, tresca = 0.0;    ///< μ_f; ψ
};

/// theory: rigid-balance. Reactions of a piece's contact points in their friction cones against its load.
struct RigidBalance {
  bool exists = true;
  Eigen::VectorXd motion;  ///< where none exists: the motion that the load drives and no contact stops
  std::vector<std::size_t> supports;  ///< points that react, of those that come nearest to a balance
};

/// `load`: the work of the load on each motion. `friction`: what every bound is multiplied by.
RigidBalance balance(const std::vector<RigidContact>& points, const Eigen::VectorXd& load,
                     double friction = 1.0);

/// What friction has to be multiplied by for a balance, to six digits; infinity where none is enough.
double friction_needed(const std::vector<RigidContact>& points, const Eigen::VectorXd& load);

/// theory: rigid-start. The motion that brings the piece to rest on springs of `stiffness` (a pressure over a
/// length) at its contact points, with what touches sticking. Only of use where a balance exists.
Eigen::VectorXd rest_on_springs(const std::vector<RigidContact>& points, const Eigen::VectorXd& load,
                                double stiffness);

}  // namespace kacanov
