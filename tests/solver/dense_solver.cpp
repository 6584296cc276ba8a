// SPDX-License-Identifier: BSD-3-Clause
// The dense reference solver's iteration for contact, friction and equilibrium.
#include "dense_solver.hpp"

#include <array>
#include <cmath>

namespace kacanov::testing {

DenseSolver::DenseSolver(const Problem& problem)
    : problem_(problem), dim_(problem.mesh.dim()), body_(problem) {
  const auto n = static_cast<Eigen::Index>(problem.load.size());
  load_ = Eigen::Map<const Vector>(problem.load.data(), n);
  for (Eigen::Index i = 0; i < n; ++i)
    if (!problem.held[i]) free_.push_back(i);
  find_rows();
}

DenseSolver::Defects DenseSolver::defects(const Vector& u, const Vector& lambda) const {
  Vector force, scaled = lambda;
  Matrix tangent;
  body_.linearise(Vector::Zero(u.size()), true, force, tangent);
  const double rounding = 1e-9 * tangent.diagonal().cwiseProduct(u).norm();
  body_.linearise(u, false, force, tangent);
  double area = 0.0, pressure = 1e-300;
  for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
    const ContactPoint& point = problem_.contact[i];
    scaled.segment(first_row_[i], 1 + point.tangents) *= point.mass;
    area += point.mass;
    pressure = std::max({pressure, std::abs(lambda(first_row_[i])),
                         lambda.segment(first_row_[i] + 1, point.tangents).norm()});
  }
  const Vector contact = rows_.transpose() * scaled, trace = rows_ * u;
  Vector reaction = force - load_ + contact, residual = reaction;
  for (const auto i : free_) reaction(i) = 0.0;
  residual -= reaction;
  Vector free_contact = contact;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (problem_.held[i]) free_contact(i) = 0.0;
  Defects out;
  // Rounding errors of the forces themselves do not count as a residual.
  out.equilibrium = std::max(0.0, residual.norm() - 1e-6 * rounding) /
                    std::max({load_.norm(), reaction.norm(), free_contact.norm(), rounding, 1e-300});
  const double size = std::max(u.cwiseAbs().maxCoeff(), 1e-300);
  double products = 0.0;
  for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
    const ContactPoint& point = problem_.contact[i];
    const double normal = lambda(first_row_[i]), open = point.gap - trace(first_row_[i]);
    const Vector t = lambda.segment(first_row_[i] + 1, point.tangents),
                 w = trace.segment(first_row_[i] + 1, point.tangents);
    const double bound = point.tresca + point.coulomb * normal;
    out.penetration = std::max(out.penetration, -open / size);
    out.tension = std::max(out.tension, -normal / pressure);
    out.cone = std::max(out.cone, (t.norm() - bound) / pressure);
    products += point.mass * (std::abs(normal * open) +
                              (point.tangents > 0 ? std::abs(bound * w.norm() - t.dot(w)) : 0.0));
  }
  out.products = area > 0.0 ? products / (pressure * size * area) : 0.0;
  return out;
}

DenseSolver::Answer DenseSolver::solve() {
  Vector bound(static_cast<Eigen::Index>(problem_.contact.size()));
  bool coulomb = false;
  for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
    bound(static_cast<Eigen::Index>(i)) = problem_.contact[i].mass * problem_.contact[i].tresca;
    coulomb = coulomb || problem_.contact[i].coulomb > 0.0;
  }
  Answer answer;
  answer.u = Eigen::Map<const Vector>(problem_.prescribed.data(), load_.size());
  for (const auto i : free_) answer.u(i) = 0.0;
  answer.forces = Vector::Zero(rows_.rows());
  // Coulomb: bounds from the previous pass's pressure, until they no longer change.
  for (int pass = 0; pass < (coulomb ? 300 : 1); ++pass) {
    answer.converged = minimise(bound, pass == 0, answer);
    if (!answer.converged) break;
    double change = 0.0, size = 0.0;
    for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const ContactPoint& point = problem_.contact[i];
      const double next = point.mass * point.tresca + point.coulomb * answer.forces(first_row_[i]);
      change = std::max(change, std::abs(next - bound(k)));
      size = std::max(size, next);
      bound(k) = next;
    }
    answer.converged = change <= 1e-11 * size;
    if (answer.converged) break;
  }
  measure(answer);
  return answer;
}

/// Fills the rows of [N; T], point by point: one row for the normal, then those of the tangents.
void DenseSolver::find_rows() {
  Eigen::Index count = 0;
  for (const ContactPoint& point : problem_.contact) {
    first_row_.push_back(count);
    count += 1 + point.tangents;
  }
  rows_ = Matrix::Zero(count, load_.size());
  for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
    const ContactPoint& point = problem_.contact[i];
    for (const RowEntry& entry : problem_.contact.entries(i))
      for (int k = 0; k <= point.tangents; ++k) {
        const Vector3& direction = k == 0 ? entry.trace : entry.tangent[k - 1];
        for (int c = 0; c < dim_; ++c)
          rows_(first_row_[i] + k, static_cast<Eigen::Index>(entry.node) * dim_ + c) = direction[c];
      }
  }
  free_rows_ = rows_(Eigen::all, free_);
}

/// Returns J(u) = stored energy − work of the loads + friction.
double DenseSolver::energy(const Vector& u, const Vector& bound) const {
  double sum = body_.stored_energy(u) - load_.dot(u);
  const Vector trace = rows_ * u;
  for (std::size_t i = 0; i < problem_.contact.size(); ++i)
    sum += bound(static_cast<Eigen::Index>(i)) *
           trace.segment(first_row_[i] + 1, problem_.contact[i].tangents).norm();
  return sum;
}

/// Projected Gauss–Seidel sweep for forces f with v = start − W f, v_n ≤ gap ⊥ f_n ≥ 0, and f_t in its disc
/// along v_t.
void DenseSolver::sweep_forces(const Matrix& w, const Vector& start, const Vector& bound, Vector& f) const {
  Vector v = start - w * f;
  const auto change_by = [&](Eigen::Index row, double delta) {
    if (delta == 0.0) return;
    f(row) += delta;
    v -= delta * w.col(row);
  };
  for (int sweep = 0; sweep < 100000; ++sweep) {
    double moved = 0.0, size = 0.0;
    for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
      const Eigen::Index n = first_row_[i];
      const double next = std::max(0.0, f(n) + (v(n) - problem_.contact[i].gap) / w(n, n));
      moved = std::max(moved, std::abs(next - f(n)));
      change_by(n, next - f(n));
      size = std::max(size, next);
      const int tangents = problem_.contact[i].tangents;
      if (tangents == 0) continue;
      const double stiff = 1.0 / w.block(n + 1, n + 1, tangents, tangents).trace();
      Vector t = f.segment(n + 1, tangents) + stiff * v.segment(n + 1, tangents);
      const double length = t.norm(), most = bound(static_cast<Eigen::Index>(i));
      if (length > most) t *= most / length;
      for (int k = 0; k < tangents; ++k) {
        moved = std::max(moved, std::abs(t(k) - f(n + 1 + k)));
        change_by(n + 1 + k, t(k) - f(n + 1 + k));
      }
      size = std::max(size, t.norm());
    }
    if (moved <= 1e-14 * size) return;
    if (sweep % 100 == 99) v = start - w * f;
  }
}

bool DenseSolver::minimise(const Vector& bound, bool from_rest, Answer& answer) {
  Vector& u = answer.u;
  Vector force;
  Matrix tangent;
  for (int step = 0; step < 200; ++step) {
    const bool elastic = from_rest && step == 0;
    body_.linearise(u, elastic, force, tangent);
    const Matrix k = tangent(free_, free_);
    const Eigen::LLT<Matrix> factor(k);
    if (factor.info() != Eigen::Success) return false;
    const Matrix lifted = factor.solve(free_rows_.transpose());
    const Vector unbalanced = (load_ - force)(free_);
    const Vector free_step = factor.solve(unbalanced);
    const Vector start = rows_ * u + free_rows_ * free_step;
    if (rows_.rows() > 0) sweep_forces(free_rows_ * lifted, start, bound, answer.forces);
    Vector d = Vector::Zero(u.size());
    d(free_) = free_step - lifted * answer.forces;
    const double size = (u + d).cwiseAbs().maxCoeff();
    // The start may penetrate an obstacle and has to leave it, even if the energy rises.
    double t = 1.0;
    if (!elastic) {
      const double before = energy(u, bound), noise = 1e-13 * (std::abs(before) + std::abs(load_.dot(u)));
      while (t > 1e-6 && energy(u + t * d, bound) > before + noise) t *= 0.5;
    }
    u += t * d;
    if (d.cwiseAbs().maxCoeff() <= 1e-11 * size) return true;
  }
  return false;
}

void DenseSolver::measure(Answer& answer) const {
  Vector force;
  Matrix tangent;
  body_.linearise(answer.u, false, force, tangent);
  answer.softest =
      Eigen::SelfAdjointEigenSolver<Matrix>(tangent(free_, free_), Eigen::EigenvaluesOnly).eigenvalues()(0);
  const Vector contact = rows_.transpose() * answer.forces;
  Vector reaction = force - load_ + contact;
  for (const auto i : free_) reaction(i) = 0.0;
  answer.force_scale = std::max({load_.norm(), contact.norm(), reaction.norm()});
}

}  // namespace kacanov::testing
