// SPDX-License-Identifier: BSD-3-Clause
// A small dense solver of the same problems, independent of the solver under test: body, laws, and solution.
#include "dense_solver.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <variant>

namespace kacanov::testing {
namespace {

/// Evaluates a table of stress at x: piecewise linear, the last piece extrapolated.
LawValues evaluate_table(const laws::Table& table, double x) {
  double energy = 0.0;
  for (std::size_t i = 1;; ++i) {
    const double from = table.x[i - 1], to = table.x[i], start = table.s[i - 1];
    const double rise = (table.s[i] - start) / (to - from);
    const bool here = x <= to || i + 1 == table.x.size();
    const double end = here ? x : to, stress = start + rise * (end - from);
    energy += 0.25 * (start + stress) * (end - from);
    if (here && i == 1) return {0.5 * rise, 0.0, energy};
    if (here) return {0.5 * stress / x, 0.5 * (rise - stress / x) / x, energy};
  }
}
/// Evaluates a table with the squared argument a = x²: g = s(a)/2a, so ∫ g x dx = ∫ s/4a da.
LawValues evaluate_squared_table(const laws::Table& table, double x) {
  const double a = x * x;
  double energy = 0.0;
  for (std::size_t i = 1;; ++i) {
    const double from = table.x[i - 1], to = table.x[i], start = table.s[i - 1];
    const double rise = (table.s[i] - start) / (to - from);
    const bool here = a <= to || i + 1 == table.x.size();
    const double end = here ? a : to, s = start + rise * (end - from);
    energy += 0.25 * rise * (end - from);
    if (i > 1) energy += 0.25 * (start - rise * from) * std::log(end / from);
    if (here && i == 1) return {0.5 * rise, 0.0, energy};
    if (here) return {0.5 * s / a, x * (rise - s / a) / a, energy};
  }
}
double yield(const Law& law) {
  return std::visit(
      [](const auto& form) {
        if constexpr (requires { form.x0; })
          return form.x0;
        else
          return 0.0;
      },
      law.form);
}
/// Evaluates a law with the squared argument.
LawValues evaluate_squared(const Law& law, double x) {
  if (const auto* table = std::get_if<laws::Table>(&law.form)) return evaluate_squared_table(*table, x);
  const double mu = law.shear, x0 = yield(law), a = x * x;
  if (law.linear() || a <= x0) return {mu, 0.0, 0.5 * mu * a};
  const double l = std::log(a / x0);
  if (std::holds_alternative<laws::Logarithmic>(law.form)) {
    return {mu * x0 / a * (l + 1.0), -2.0 * x * mu * x0 * l / (a * a),
            0.5 * mu * x0 * (1.0 + l + 0.5 * l * l)};
  }
  if (const auto* form = std::get_if<laws::LinearHardening>(&law.form)) {
    const double gamma = form->gamma;
    return {mu * (gamma + (1.0 - gamma) * x0 / a), -2.0 * x * mu * (1.0 - gamma) * x0 / (a * a),
            0.5 * mu * (x0 + gamma * (a - x0) + (1.0 - gamma) * x0 * l)};
  }
  if (const auto* form = std::get_if<laws::Power>(&law.form)) {
    const double n = form->n;
    const double g = mu * std::pow(a / x0, n - 1.0);
    return {g, 2.0 * x * (n - 1.0) * g / a, 0.5 * mu * x0 * (1.0 + (std::pow(a / x0, n) - 1.0) / n)};
  }
  if (const auto* form = std::get_if<laws::Saturating>(&law.form)) {
    const double q = form->q;
    // ∫ e^-b/qx₀ / b db from x₀ to a equals E₁(1/q) − E₁(a/qx₀), where E₁(z) = −Ei(−z).
    const double decay = std::exp(-(a - x0) / (q * x0)), g = mu * x0 / a * (1.0 + q * (1.0 - decay));
    const double faded = std::exp(1.0 / q) * (std::expint(-a / (q * x0)) - std::expint(-1.0 / q));
    return {g, 2.0 * x * (mu * decay - g) / a, 0.5 * mu * x0 * (1.0 + (1.0 + q) * l - q * faded)};
  }
  return {NAN, NAN, NAN};
}

}  // namespace

LawValues evaluate_law(const Law& law, double x) {
  if (law.argument == Law::Argument::squared) return evaluate_squared(law, x);
  if (const auto* table = std::get_if<laws::Table>(&law.form)) return evaluate_table(*table, x);
  const double mu = law.shear, x0 = yield(law);
  if (law.linear() || x <= x0) return {mu, 0.0, 0.5 * mu * x * x};
  const double below = 0.5 * mu * x0 * x0;
  if (std::holds_alternative<laws::Logarithmic>(law.form)) {
    const double l = std::log(x / x0);
    return {mu * x0 / x * (l + 1.0), -mu * x0 * l / (x * x), below + mu * x0 * x * l};
  }
  if (const auto* form = std::get_if<laws::LinearHardening>(&law.form)) {
    const double gamma = form->gamma;
    return {mu * (gamma + (1.0 - gamma) * x0 / x), -mu * (1.0 - gamma) * x0 / (x * x),
            below + mu * (0.5 * gamma * (x * x - x0 * x0) + (1.0 - gamma) * x0 * (x - x0))};
  }
  if (const auto* form = std::get_if<laws::Power>(&law.form)) {
    const double n = form->n;
    return {mu * std::pow(x / x0, n - 1.0), mu * (n - 1.0) / x * std::pow(x / x0, n - 1.0),
            below + mu * x0 * x0 * (std::pow(x / x0, n + 1.0) - 1.0) / (n + 1.0)};
  }
  if (const auto* form = std::get_if<laws::Saturating>(&law.form)) {
    const double q = form->q;
    const double decay = std::exp(-(x - x0) / (q * x0)), stress = mu * x0 * (1.0 + q * (1.0 - decay));
    return {stress / x, (mu * decay - stress / x) / x,
            below + mu * x0 * ((1.0 + q) * (x - x0) - q * q * x0 * (1.0 - decay))};
  }
  return {NAN, NAN, NAN};
}

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
