// SPDX-License-Identifier: BSD-3-Clause
// The body of the dense reference solver: elements assembled into dense forces and matrices.
#include "dense_body.hpp"

#include <cmath>
#include <utility>

#include "dense_laws.hpp"

namespace kacanov::testing {
namespace {

using Matrix = DenseBody::Matrix;

/// Returns the gradients of the shape functions in the reference element: nodes × dim.
Matrix reference_gradients(ElementType type, const Eigen::Vector3d& x) {
  if (type == ElementType::tri3) return (Matrix(3, 2) << -1, -1, 1, 0, 0, 1).finished();
  if (type == ElementType::tet4) return (Matrix(4, 3) << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1).finished();
  if (type == ElementType::tet10) {
    // Barycentric coordinates λ: corners (2λ − 1) λ, then products of the ends' coordinates for mid-edge
    // nodes.
    constexpr int ends[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};
    const Eigen::Vector4d l(1.0 - x.sum(), x(0), x(1), x(2));
    const Matrix corners = (Matrix(4, 3) << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1).finished();
    Matrix gradients(10, 3);
    for (int a = 0; a < 4; ++a) gradients.row(a) = (4.0 * l(a) - 1.0) * corners.row(a);
    for (int e = 0; e < 6; ++e)
      gradients.row(4 + e) =
          4.0 * (l(ends[e][0]) * corners.row(ends[e][1]) + l(ends[e][1]) * corners.row(ends[e][0]));
    return gradients;
  }
  // quad4 on [−1, 1]² and hex8 on [−1, 1]³, the lower face first, counter-clockwise.
  constexpr int corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const int dim = type == ElementType::quad4 ? 2 : 3, nodes = 1 << dim;
  Matrix gradients(nodes, dim);
  for (int a = 0; a < nodes; ++a)
    for (int c = 0; c < dim; ++c) {
      double value = corner[a][c] / double(nodes);
      for (int d = 0; d < dim; ++d)
        if (d != c) value *= 1.0 + corner[a][d] * x(d);
      gradients(a, c) = value;
    }
  return gradients;
}

/// Returns the quadrature points of the reference element with their weights.
std::vector<std::pair<Eigen::Vector3d, double>> quadrature(ElementType type) {
  std::vector<std::pair<Eigen::Vector3d, double>> rule;
  if (type == ElementType::hex8) {
    const double p = 1.0 / std::sqrt(3.0);
    for (const double x : {-p, p})
      for (const double y : {-p, p})
        for (const double z : {-p, p}) rule.emplace_back(Eigen::Vector3d(x, y, z), 1.0);
  } else if (type == ElementType::quad4) {
    const double p = 1.0 / std::sqrt(3.0);
    for (const double x : {-p, p})
      for (const double y : {-p, p}) rule.emplace_back(Eigen::Vector3d(x, y, 0.0), 1.0);
  } else if (type == ElementType::tet10) {
    const double off = (5.0 - std::sqrt(5.0)) / 20.0;
    for (int vertex = -1; vertex < 3; ++vertex) {
      Eigen::Vector3d at = Eigen::Vector3d::Constant(off);
      if (vertex >= 0) at(vertex) = 1.0 - 3.0 * off;
      rule.emplace_back(at, 1.0 / 24.0);
    }
  } else {
    rule.emplace_back(Eigen::Vector3d::Zero(), type == ElementType::tri3 ? 0.5 : 1.0 / 6.0);
  }
  return rule;
}

}  // namespace

DenseBody::DenseBody(const Problem& problem) : problem_(problem), dim_(problem.mesh.dim()) {
  const Mesh& mesh = problem.mesh;
  const int npe = nodes_per_element(mesh.type);
  const auto rule = quadrature(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    Matrix x(npe, dim_);
    std::vector<Eigen::Index> unknowns;
    for (int a = 0; a < npe; ++a) {
      const std::size_t node = mesh.elements[e * static_cast<std::size_t>(npe) + static_cast<std::size_t>(a)];
      for (int c = 0; c < dim_; ++c) {
        x(a, c) = mesh.coordinates[node * static_cast<std::size_t>(dim_) + static_cast<std::size_t>(c)];
        unknowns.push_back(static_cast<Eigen::Index>(node) * dim_ + c);
      }
    }
    unknowns_.push_back(unknowns);
    for (const auto& [at, weight] : rule) {
      const Matrix gradients = reference_gradients(mesh.type, at);
      const Matrix jacobian = x.transpose() * gradients;  // dx_c / dξ_d
      const Matrix physical = gradients * jacobian.inverse();
      Point point;
      point.weight = weight * jacobian.determinant();
      point.element = e;
      point.b = Matrix::Zero(6, npe * dim_);
      const double half = 1.0 / std::sqrt(2.0);
      for (int a = 0; a < npe; ++a) {
        for (int c = 0; c < dim_; ++c) point.b(c, a * dim_ + c) = physical(a, c);
        constexpr int pair[3][2] = {{0, 1}, {1, 2}, {0, 2}};
        for (int k = 0; k < 3; ++k) {
          const int c = pair[k][0], d = pair[k][1];
          if (c >= dim_ || d >= dim_) continue;
          point.b(3 + k, a * dim_ + c) += half * physical(a, d);
          point.b(3 + k, a * dim_ + d) += half * physical(a, c);
        }
      }
      points_.push_back(point);
    }
    if (law(e).mean_dilatation) take_mean_dilatation(static_cast<std::ptrdiff_t>(rule.size()));
  }
}

void DenseBody::take_mean_dilatation(std::ptrdiff_t count) {
  const auto first = points_.end() - count;
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(first->b.cols());
  double volume = 0.0;
  for (auto point = first; point != points_.end(); ++point) {
    mean += point->weight * point->b.topRows(3).colwise().sum();
    volume += point->weight;
  }
  for (auto point = first; point != points_.end(); ++point) {
    const Eigen::RowVectorXd shift = (mean / volume - point->b.topRows(3).colwise().sum()) / 3.0;
    point->b.topRows(3).rowwise() += shift;
  }
}

double DenseBody::stored_energy(const Vector& u) const {
  double sum = 0.0;
  for (const Point& point : points_) {
    const Vector strain = point.b * u(unknowns_[point.element]);
    const double trace = strain.head<3>().sum();
    Vector dev = strain;
    dev.head<3>().array() -= trace / 3.0;
    const Law& of = law(point.element);
    sum += point.weight * (0.5 * of.bulk * trace * trace + 2.0 * evaluate_law(of, dev.norm()).energy);
  }
  return sum;
}

void DenseBody::linearise(const Vector& u, bool elastic, Vector& force, Matrix& tangent) const {
  force = Vector::Zero(u.size());
  tangent = Matrix::Zero(u.size(), u.size());
  Eigen::Matrix<double, 6, 1> ones;
  ones << 1, 1, 1, 0, 0, 0;
  const Eigen::Matrix<double, 6, 6> volume = ones * ones.transpose(),
                                    deviator = Eigen::Matrix<double, 6, 6>::Identity() - volume / 3.0;
  for (const Point& point : points_) {
    const auto& unknowns = unknowns_[point.element];
    const Eigen::Matrix<double, 6, 1> strain = point.b * u(unknowns), dev = deviator * strain;
    const Law& of = law(point.element);
    const double x = dev.norm();
    const LawValues values = elastic ? LawValues{of.shear, 0.0, 0.0} : evaluate_law(of, x);
    Eigen::Matrix<double, 6, 6> c = of.bulk * volume + 2.0 * values.g * deviator;
    const Eigen::Matrix<double, 6, 1> stress = c * strain;
    if (x > 0.0) c += (2.0 * values.slope / x) * dev * dev.transpose();
    force(unknowns) += point.weight * (point.b.transpose() * stress);
    tangent(unknowns, unknowns) += point.weight * (point.b.transpose() * c * point.b);
  }
}

}  // namespace kacanov::testing
