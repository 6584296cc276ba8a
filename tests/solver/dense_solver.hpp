// SPDX-License-Identifier: BSD-3-Clause
// A small dense solver of the same problems, independent of the solver under test: body, laws, and solution.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include <kacanov/law.hpp>
#include <kacanov/problem.hpp>

namespace kacanov::testing {

class DenseBody {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  /// `problem` must outlive this object.
  explicit DenseBody(const Problem& problem);

  double stored_energy(const Vector& u) const;
  /// Computes internal forces and tangent; with `elastic`, those of the body with g = μ.
  void linearise(const Vector& u, bool elastic, Vector& force, Matrix& tangent) const;

 private:
  struct Point {
    double weight = 0.0;
    std::size_t element = 0;
    Matrix b;  ///< 6 × (nodes · dim): strain in Mandel notation
  };
  /// B-bar: replaces the trace at each of the last `count` points by their mean.
  void take_mean_dilatation(std::ptrdiff_t count);
  const Law& law(std::size_t element) const { return problem_.laws[problem_.law_of_element[element]]; }

  const Problem& problem_;
  int dim_;
  std::vector<Point> points_;
  std::vector<std::vector<Eigen::Index>> unknowns_;  ///< per element
};

/// g, dg/dx and ∫ g s ds of a law, from the formulas in the documentation of case files.
struct LawValues {
  double g, slope, energy;
};

/// Evaluates the law at the strain x = ‖dev ε‖.
LawValues evaluate_law(const Law& law, double x);

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
