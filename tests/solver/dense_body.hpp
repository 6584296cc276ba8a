// SPDX-License-Identifier: BSD-3-Clause
// The body of the dense reference solver: elements assembled into dense forces and matrices.
#pragma once

#include <Eigen/Dense>
#include <vector>

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

}  // namespace kacanov::testing
