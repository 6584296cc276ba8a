// SPDX-License-Identifier: BSD-3-Clause
// Dense reference solver for small problems, which shares only the lists of loads and contact points with the
// solver. It assembles its own matrices and solves quadratic programs with an energy line search, their duals
// by projected Gauss–Seidel on the dense compliance of the contact points (Jean and Moreau).
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "dense_body.hpp"

namespace kacanov::testing {

class DenseSolver {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  /// `problem` must outlive this object.
  explicit DenseSolver(const Problem& problem);

  struct Answer {
    Vector u;
    Vector forces;  ///< contact forces, one entry per row: M λ_n, M λ_t
    bool converged = false;
    double softest = 0.0;      ///< smallest eigenvalue of the tangent on free components, without contact
    double force_scale = 0.0;  ///< largest ‖·‖₂ among loads, reactions and contact forces
  };

  /// Relative residuals of the problem's conditions for a given displacement and given contact pressures and
  /// tractions (λ_n and λ_t, the force of the body on the obstacle); the scales come from that state itself.
  struct Defects {
    double equilibrium = 0.0, penetration = 0.0, tension = 0.0, cone = 0.0, products = 0.0;
    double worst() const { return std::max({equilibrium, penetration, tension, cone, products}); }
  };
  Defects defects(const Vector& u, const Vector& lambda) const;
  const std::vector<Eigen::Index>& first_rows() const { return first_row_; }

  Answer solve();

 private:
  void find_rows();
  double energy(const Vector& u, const Vector& bound) const;
  void sweep_forces(const Matrix& w, const Vector& start, const Vector& bound, Vector& f) const;
  bool minimise(const Vector& bound, bool from_rest, Answer& answer);
  void measure(Answer& answer) const;

  const Problem& problem_;
  int dim_;
  DenseBody body_;
  Vector load_;
  std::vector<Eigen::Index> free_;
  std::vector<Eigen::Index> first_row_;
  Matrix rows_, free_rows_;
};

}  // namespace kacanov::testing
