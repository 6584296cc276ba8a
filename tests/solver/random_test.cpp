// SPDX-License-Identifier: BSD-3-Clause
// Random small problems, solved by the solver and by the independent dense solver: no run may be reported as
// converged that is not.
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <random>

#include "../sanitized.hpp"
#include "dense_solver.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A random generator whose numbers are the same with every standard library.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {
    for (int i = 0; i < 8; ++i) engine_();
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double decades(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  int whole(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  Vector3 direction(int dim) {
    Vector3 v{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c) v[c] = uniform(-1.0, 1.0);
    const double size = std::max(length(v), 0.1);
    for (double& c : v) c /= size;
    return v;
  }

 private:
  std::mt19937 engine_;
};

struct Sample {
  Mesh mesh;
  Model model;
};

Law random_law(Dice& dice, double modulus, double strain) {
  Law law = elastic_law(modulus, dice.uniform(0.0, 0.45));
  const int kind = dice.whole(0, 5);
  double x0 = strain * dice.decades(-0.7, 0.5);
  double gamma = dice.decades(-1.5, -0.1);
  double n = dice.uniform(0.2, 0.9);
  const double q = dice.decades(0.0, 1.5);
  // Parameters for which stress still increases with strain: always for these n, γ and tables, up to √e times
  // the yield strain for law-logarithmic, about as far or further for saturating laws.
  const bool squared = dice.chance(0.3);
  if (squared) {
    law.argument = Law::Argument::squared;
    n = 0.55 + 0.5 * n;
    gamma = 0.55 + 0.5 * gamma;
    if (kind == 1 || kind == 4) x0 *= 4.0;
    x0 *= x0;
  }
  const Law::Form forms[] = {laws::Linear{},     laws::Logarithmic{x0},   laws::LinearHardening{x0, gamma},
                             laws::Power{x0, n}, laws::Saturating{x0, q}, laws::Table{}};
  law.form = forms[kind];
  if (auto* table = std::get_if<laws::Table>(&law.form)) {
    table->x = {0.0, x0, x0 * dice.uniform(1.5, 3.0), x0 * dice.uniform(4.0, 8.0)};
    table->s = {0.0};
    double slope = 2.0 * law.shear;
    for (std::size_t i = 1; i < table->x.size(); ++i) {
      table->s.push_back(table->s.back() + slope * (table->x[i] - table->x[i - 1]));
      // With the squared argument the stress is s/x, which increases while the slope is at least half of s/a.
      slope *= squared ? dice.uniform(0.75, 0.95) : dice.uniform(0.1, 0.9);
    }
  }
  return law;
}

Vector3 times(double factor, const Vector3& v) { return {factor * v[0], factor * v[1], factor * v[2]}; }

/// An obstacle below (axis: the vertical one) or to the right (axis 0) of the body, at a distance of about
/// `gap`.
Obstacle random_obstacle(Dice& dice, int dim, std::size_t axis, double side, const Vector3& size,
                         double gap) {
  const int kind = dice.whole(0, 3);
  if (kind == 0) return ConstantGap{gap};
  Vector3 point = times(0.5, size), out{};
  if (dim == 2) point[2] = 0.0;
  out[axis] = side;
  point[axis] = side < 0.0 ? -gap : size[axis] + gap;
  if (kind == 1) {
    Vector3 normal = times(-1.0, out);
    const Vector3 tilt = dice.direction(dim);
    for (std::size_t c = 0; c < 3; ++c) normal[c] += 0.02 * tilt[c];
    return Plane{point, normal};
  }
  Sphere sphere;
  sphere.radius = dice.uniform(2.0, 8.0);
  sphere.centre = point;
  sphere.centre[axis] += side * sphere.radius;
  if (kind == 2) sphere.direction = out;
  return sphere;
}

Sample random_problem(unsigned seed) {
  Dice dice(seed);
  Sample sample;
  constexpr std::array element_types{ElementType::tri3, ElementType::quad4, ElementType::tet4,
                                     ElementType::hex8, ElementType::tet10};
  const ElementType type = element_types[seed % 5];
  const int dim = dimension(type);
  const std::size_t up = dim - 1;
  BoxSpec spec;
  spec.type = type;
  const int most = dim == 2 ? 5 : type == ElementType::tet10 ? 1 : 2;
  for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c) {
    spec.cells[c] = dice.whole(c == 0 ? 2 : 1, c == 0 ? most + 1 : most);
    spec.size[c] = dice.uniform(0.5, 2.0);
  }
  sample.mesh = make_box(spec);
  double cell = 1e9;  // node spacing
  for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c)
    cell = std::min(cell, spec.size[c] / spec.cells[c]);
  if (type == ElementType::tet10) cell *= 0.5;
  map_nodes(sample.mesh, [&](const Vector3& x) {
    const Vector3 shift = dice.direction(dim);
    return Vector3{x[0] + 0.1 * cell * shift[0], x[1] + 0.1 * cell * shift[1], x[2] + 0.1 * cell * shift[2]};
  });

  const double modulus = dice.decades(-2.0, 4.0), strain = dice.decades(-4.0, -1.3);
  const double length = spec.size[up], move = strain * length;
  Model& model = sample.model;
  model.materials.push_back({everything(), random_law(dice, modulus, strain)});
  if (dice.chance(0.3)) {
    Vector3 low{-1, -1, -1}, high{3, 3, 3};
    high[0] = 0.75 * spec.size[0];
    const Law law = random_law(dice, modulus * dice.decades(-1.0, 1.0), strain);
    if (spec.cells[0] >= 3) model.materials.push_back({box(low, high), law});
  }

  // Supports that make the dense matrix definite without contact.
  const bool from_above = dice.chance(0.4);
  if (from_above) {
    Vector3 shift{};
    shift[up] = -move * dice.uniform(0.0, 1.0);
    shift[0] = move * dice.uniform(-0.3, 0.3);
    model.boundary.push_back(moved(named("top"), dim, shift));
    if (dice.chance(0.7))
      model.boundary.push_back(traction(named("right"), times(modulus * strain, dice.direction(dim))));
  } else {
    model.boundary.push_back(moved(named("left"), dim));
    if (dim == 3 && dice.chance(0.3)) model.boundary.push_back(roller(named("front"), 1));
    Vector3 pull = dice.direction(dim);
    pull[up] = -std::abs(pull[up]);
    if (dice.chance(0.8))
      model.boundary.push_back(traction(named("top"), times(modulus * strain, pull)));
    else
      model.boundary.push_back(pressure(named("top"), modulus * strain * dice.uniform(-0.3, 1.0)));
    if (dice.chance(0.3))
      model.boundary.push_back(
          body_force(everything(), times(modulus * strain / length, dice.direction(dim))));
  }

  std::optional<Friction> friction;
  const double kind = dice.uniform(0.0, 1.0);
  if (kind > 0.35) friction = Friction{modulus * strain * dice.decades(-2.0, 0.3), 0.0};
  if (kind > 0.75) friction = Friction{0.0, dice.uniform(0.05, 0.3)};
  const double gap = dice.chance(0.3) ? 0.0 : move * dice.uniform(-0.5, 1.0);
  ContactEntry below;
  below.on = named("bottom");
  below.obstacle = random_obstacle(dice, dim, up, -1.0, spec.size, gap);
  below.friction = friction;
  model.contact.push_back(below);
  if (dice.chance(0.3)) {
    ContactEntry beside;
    beside.on = named("right");
    beside.obstacle = random_obstacle(dice, dim, 0, 1.0, spec.size, move * dice.uniform(-0.3, 0.5));
    if (dice.chance(0.5)) beside.friction = friction;
    model.contact.push_back(beside);
  }

  constexpr std::array tolerances{1e-5, 1e-6, 1e-7, 1e-8};
  model.solver.tolerance = tolerances[dice.whole(0, 3)];
  return sample;
}

int environment(const char* name, int otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? std::atoi(value) : otherwise;
}

constexpr int usual_count = sanitized ? 40 : 500;

/// The solver's state in the order of the problem and of the dense solver's rows.
struct State {
  Eigen::VectorXd u, lambda;
};
State state_of(const Run& run, const DenseSolver& dense) {
  const std::size_t dim = run.part.dim();
  const std::vector<double> u = gather_nodal(run.part, run.solution.displacement, run.part.dim());
  State state{Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size())), {}};
  Eigen::Index rows = 0;
  for (const ContactPoint& point : run.problem.contact) rows += 1 + point.tangents;
  state.lambda = Eigen::VectorXd::Zero(rows);
  for (std::size_t i = 0; i < run.part.contact.size(); ++i) {
    const std::size_t index = run.part.contact_index[i];
    const ContactPoint& point = run.problem.contact[index];
    const Eigen::Index row = dense.first_rows()[index];
    state.lambda(row) = run.solution.pressure[i];
    for (int k = 0; k < point.tangents; ++k)
      for (std::size_t c = 0; c < dim; ++c)
        state.lambda(row + 1 + k) -= run.solution.traction[i][c] * point.tangent[k][c];
  }
  return state;
}

struct Tally {
  int solved = 0, unconverged = 0, limited = 0, undecided = 0, softened = 0;
  double worst_defect = 0.0, worst_error = 0.0;  ///< relative to the tolerance, relative to the bound
};

void compare(int seed, const Sample& sample, Tally& tally) {
  CAPTURE(seed);
  const Run run = run_alone(sample.mesh, sample.model);
  DenseSolver dense(run.problem);
  const State state = state_of(run, dense);
  const bool converged = run.result().status == Status::converged;
  const double tolerance = sample.model.solver.tolerance;
  const DenseSolver::Answer answer = dense.solve();
  const double error = (state.u - answer.u).norm();
  // A residual equal to the tolerance moves the softest mode by that residual over its stiffness, and every
  // other mode by less.
  const double bound = tolerance * (answer.force_scale / answer.softest + answer.u.norm());
  const DenseSolver::Defects defects = dense.defects(state.u, state.lambda);
  if (std::getenv("KACANOV_RANDOM_VERBOSE") != nullptr)
    std::cout << seed << (converged ? " converged" : " NOT CONVERGED")
              << (answer.converged ? "" : " DENSE UNDECIDED") << ", unknowns " << run.part.unknowns()
              << ", law " << run.part.laws[0].form.index() << ", outer " << run.result().outer_iterations
              << ", tolerance " << tolerance << ", defect " << defects.worst() / tolerance << ", error "
              << error / answer.u.norm() << " = " << error / bound << " of its bound; "
              << run.result().message << "\n";
  ++tally.solved;
  // The problem is not monotone there: a solution need not exist or be unique.
  const bool softened = run.result().softening_elements > 0;
  tally.softened += softened;
  tally.undecided += !answer.converged && !softened;
  const bool limited = run.result().status == Status::limited_by_rounding;
  tally.limited += limited;
  // Beyond a limit load no solution exists either, and the dense solver does not converge.
  tally.unconverged += !converged && !limited && !softened && answer.converged;
  // A rigid motion, or a tolerance below the rounding errors: the answer must still be right.
  if (limited) {
    const Certificate& c = run.result().certificate;
    CHECK(c.worst() + c.rounding.worst() > tolerance);
    if (answer.converged && !softened) CHECK(error <= 4.0 * bound);
  }
  if (!converged) return;
  tally.worst_defect = std::max(tally.worst_defect, defects.worst() / tolerance);
  CHECK(defects.worst() <= 1.01 * tolerance + 1e-13);
  if (!answer.converged || softened) return;
  tally.worst_error = std::max(tally.worst_error, error / bound);
  CHECK(error <= 4.0 * bound);
}

/// Calls `use` for the seeds of a test case; KACANOV_RANDOM_FIRST and KACANOV_RANDOM_COUNT select others.
template <class Use>
void for_seeds(int count, const Use& use) {
  const int first = environment("KACANOV_RANDOM_FIRST", 1);
  count = environment("KACANOV_RANDOM_COUNT", count);
  for (int seed = first; seed < first + count; ++seed) use(seed, random_problem(static_cast<unsigned>(seed)));
}

void report(const Tally& tally) {
  MESSAGE(tally.unconverged, " of ", tally.solved, " not converged, ", tally.limited,
          " limited by rounding, dense solver undecided on ", tally.undecided, ", ", tally.softened,
          " in a softening range; of the others the largest defect is ", tally.worst_defect,
          " of the tolerance, the largest error ", tally.worst_error, " of its bound");
}

}  // namespace

TEST_CASE("random problems: what is called converged is the solution of the dense solver") {
  Tally tally;
  for_seeds(usual_count, [&](int seed, const Sample& sample) { compare(seed, sample, tally); });
  report(tally);
  CHECK(tally.unconverged <= tally.solved / 500);
  CHECK(tally.limited <= 2 + tally.solved / 50);  // the sanitizers draw few problems
  CHECK(tally.undecided <= tally.solved / 50);
  CHECK(tally.softened <= 3 + tally.solved / 20);
}

TEST_CASE("the dense solver sees what is not a solution") {
  for (const int seed : {1, 2, 4, 5, 6, 7, 9, 13}) {  // every element type; no softening, no rigid motion
    CAPTURE(seed);
    Sample sample = random_problem(static_cast<unsigned>(seed));
    sample.model.solver.tolerance = 1e-8;
    const Run run = run_alone(sample.mesh, sample.model);
    DenseSolver dense(run.problem);
    const State state = state_of(run, dense);
    CHECK(dense.defects(state.u, state.lambda).worst() <= 1.01e-8);
    CHECK(dense.defects(1.0001 * state.u, state.lambda).worst() > 1e-7);
    if (state.lambda.norm() > 0.0) CHECK(dense.defects(state.u, 1.0001 * state.lambda).worst() > 1e-7);
    const DenseSolver::Answer answer = dense.solve();
    CHECK((answer.u - state.u).norm() < 1e-5 * answer.u.norm());
    CHECK((answer.u - 1.0001 * state.u).norm() > 9e-5 * answer.u.norm());
  }
}

TEST_CASE("random problems by other methods, which need not converge but may not lie") {
  using Options = SolverOptions;
  Tally tally;
  for_seeds(usual_count / 5, [&](int seed, Sample sample) {
    Options& solver = sample.model.solver;
    constexpr std::array methods{Options::Contact::admm, Options::Contact::dual_admm,
                                 Options::Contact::active_set};
    solver.contact = methods[seed % 3];
    if (seed % 2 == 0) solver.outer = Options::Outer::kacanov;
    if (seed % 5 == 0) solver.penalty = Options::Penalty::paper;
    if (seed % 5 == 1 && seed % 3 < 2) solver.stop = Options::Stop::paper;
    if (seed % 7 == 0) solver.preconditioner = Options::Preconditioner::elasticity;
    solver.max_outer = 30;
    solver.max_contact = 300;
    compare(seed, sample, tally);
  });
  report(tally);
  CHECK(tally.unconverged <= tally.solved / 2);
}
