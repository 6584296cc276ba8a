// SPDX-License-Identifier: BSD-3-Clause
// A problem in other units has the same answer: bitwise for powers of two, otherwise up to rounding errors.
#include <doctest/doctest.h>

#include "partition/nondimensionalisation.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Units of length and modulus relative to those of another problem.
struct Scale {
  double length = 1.0, modulus = 1.0;
};

void scale(Vector3& v, double factor) {
  for (double& x : v) x *= factor;
}

void scale(Selector& on, double factor) {
  scale(on.lower, factor);
  scale(on.upper, factor);
}

/// Returns the model with lengths and moduli in other units: strains do not change.
Model in_units(Model model, const Scale& s) {
  for (MaterialEntry& entry : model.materials) {
    scale(entry.on, s.length);
    entry.law.bulk *= s.modulus;
    entry.law.shear *= s.modulus;
    if (auto* table = std::get_if<laws::Table>(&entry.law.form))
      for (double& stress : table->s) stress *= s.modulus;
  }
  for (BoundaryEntry& entry : model.boundary) {
    scale(entry.on, s.length);
    if (entry.displacement)
      for (auto& u : *entry.displacement)
        if (u) *u *= s.length;
    if (entry.traction) scale(*entry.traction, s.modulus);
    if (entry.pressure) *entry.pressure *= s.modulus;
    if (entry.body_force) scale(*entry.body_force, s.modulus / s.length);
  }
  for (ContactEntry& entry : model.contact) {
    scale(entry.on, s.length);
    if (auto* plane = std::get_if<Plane>(&entry.obstacle)) scale(plane->point, s.length);
    if (auto* sphere = std::get_if<Sphere>(&entry.obstacle)) {
      scale(sphere->centre, s.length);
      sphere->radius *= s.length;
    }
    if (auto* gap = std::get_if<ConstantGap>(&entry.obstacle)) gap->gap *= s.length;
    if (entry.friction) entry.friction->tresca *= s.modulus;
  }
  for (Vector3& probe : model.probes) scale(probe, s.length);
  if (model.solver.penalty == SolverOptions::Penalty::fixed) model.solver.r *= s.modulus / s.length;
  return model;
}

Run solved(int dim, const Model& model, const Scale& s, const RunOptions& options = {}) {
  BoxSpec spec{
      {4 * s.length, s.length, s.length}, {8, 2, 2}, dim == 2 ? ElementType::tri3 : ElementType::hex8};
  return run_alone(make_box(spec), in_units(model, s), options);
}

std::vector<Model> models(int dim) {
  std::vector<Model> all;
  Model model = beam(dim, logarithmic_law(2e-3), 2e-3, 5e-4);
  model.boundary.push_back({everything(), {}, {}, {}, {}, Vector3{1e-4, 0, 0}});
  model.solver.load_steps = {0.5, 1.0};
  all.push_back(model);
  model = beam(dim, elastic_law(1.0, 0.3), 1e-3);
  model.contact[0].friction = Friction{0.0, 0.4};
  model.contact[0].obstacle = Sphere{dim == 2 ? Vector3{2, -3, 0} : Vector3{2, 0.5, -3}, 3.0, {}};
  model.solver.penalty = SolverOptions::Penalty::paper;
  all.push_back(model);
  Law table = elastic_law(1.0, 0.3);
  table.form = laws::Table{{0, 1e-3, 1e-2}, {0, 2e-3 * table.shear, 6e-3 * table.shear}};
  table.argument = Law::Argument::norm;
  model = beam(dim, table, 2e-3);
  model.contact[0].obstacle = ConstantGap{1e-3};
  model.boundary.push_back(pressure(box({4, 0, 0}, {4, 1, 1}), 1e-4));
  model.solver.contact = SolverOptions::Contact::admm;
  model.solver.penalty = SolverOptions::Penalty::fixed;
  model.solver.r = 0.3;
  all.push_back(model);
  Law squared = logarithmic_law(1e-4);
  squared.argument = Law::Argument::squared;
  model = beam(dim, squared, 1e-3);
  all.push_back(model);
  return all;
}

/// Returns every number of a result that has a unit, divided by that unit.
std::vector<double> numbers(const Run& run, const Scale& s, int dim) {
  const double area = dim == 2 ? s.length : s.length * s.length, force = s.modulus * area;
  std::vector<double> all;
  const auto add = [&](double value, double unit) { all.push_back(value / unit); };
  const auto add_vector = [&](const Vector3& v, double unit) {
    for (const double x : v) add(x, unit);
  };
  const Result& result = run.result();
  for (const double u : run.solution.displacement) add(u, s.length);
  for (const double gap : run.solution.gap) add(gap, s.length);
  for (const double p : run.solution.pressure) add(p, s.modulus);
  for (const Vector3& t : run.solution.traction) add_vector(t, s.modulus);
  for (const double r : result.r) add(r, s.modulus / s.length);
  for (const double r : {result.r_star, result.r_active}) add(r, s.modulus / s.length);
  for (const double lambda : {result.lambda_min, result.lambda_max}) add(lambda, s.length / s.modulus);
  add_vector(result.contact_force, force);
  add_vector(result.friction_force, force);
  add(result.max_contact_pressure, s.modulus);
  add(result.max_von_mises, s.modulus);
  for (const Vector3& probe : result.probe) add_vector(probe, s.length);
  for (const LoadStep& step : result.load_steps) {
    add_vector(step.contact_force, force);
    add(step.max_contact_pressure, s.modulus);
    for (const Vector3& probe : step.probe) add_vector(probe, s.length);
  }
  add(result.certificate.worst(), 1.0);
  add(result.certificate.rounding.worst(), 1.0);
  return all;
}

}  // namespace

TEST_CASE("in units that are powers of two of others, results are the same bits") {
  for (const int dim : {2, 3})
    for (const Model& model : models(dim)) {
      const Run plain = solved(dim, model, {});
      REQUIRE(plain.result().status == Status::converged);
      for (const Scale& s : {Scale{0x1p-7, 0x1p17}, Scale{0x1p-130, 0x1p-131}, Scale{0x1p66, 0x1p66}}) {
        CAPTURE(dim);
        CAPTURE(s.length);
        const Run run = solved(dim, model, s);
        CHECK(run.result().message == plain.result().message);
        CHECK(numbers(run, s, dim) == numbers(plain, {}, dim));
      }
    }
}

TEST_CASE("in any units results are the same numbers") {
  for (const int dim : {2, 3})
    for (Model model : models(dim)) {
      model.solver.tolerance = 2e-12;  // rounding errors reach 6.8e-13 in one of them
      const Run plain = solved(dim, model, {});
      INFO(plain.result().message);
      REQUIRE(plain.result().status == Status::converged);
      for (const Scale& s :
           {Scale{1e-3, 2.1e11}, Scale{1e-40, 1e-40}, Scale{1e20, 1e20}, Scale{1e-40, 1e20}}) {
        CAPTURE(dim);
        CAPTURE(s.length);
        CAPTURE(s.modulus);
        const Run run = solved(dim, model, s);
        CHECK(run.result().status == Status::converged);
        CHECK(run.result().max_von_mises / s.modulus ==
              doctest::Approx(plain.result().max_von_mises).epsilon(1e-12));
        CHECK(run.result().max_contact_pressure / s.modulus ==
              doctest::Approx(plain.result().max_contact_pressure).epsilon(1e-12));
        for (std::size_t c = 0; c < 2; ++c)
          CHECK(run.probe()[c] / s.length == doctest::Approx(plain.probe()[c]).epsilon(1e-12));
      }
    }
}

TEST_CASE("a part is what it was, to the bit, after it is solved in its own units, and after an error") {
  Run run = solved(3, models(3)[0], {1e-3, 2.1e11});
  const Part before = run.part;
  solve(run.part, {}, {});
  analyse_spectrum(run.part, {}, {});
  active_penalty(run.part, run.solution, {}, {});
  RunOptions failing;
  failing.progress = [](const ProgressStep&) { throw InternalError("of the caller's"); };
  CHECK_THROWS_AS(solve(run.part, {}, failing), InternalError);
  CHECK(run.part.coordinates == before.coordinates);
  CHECK(run.part.load == before.load);
  CHECK(run.part.prescribed == before.prescribed);
  CHECK(run.part.laws[0].shear == before.laws[0].shear);
  CHECK(std::get<laws::Logarithmic>(run.part.laws[0].form).x0 ==
        std::get<laws::Logarithmic>(before.laws[0].form).x0);
  for (std::size_t i = 0; i < before.contact.size(); ++i) {
    CHECK(run.part.contact[i].gap == before.contact[i].gap);
    CHECK(run.part.contact[i].mass == before.contact[i].mass);
    CHECK(run.part.contact[i].tresca == before.contact[i].tresca);
  }
}

TEST_CASE("progress, spectrum and r_A are in the user's units") {
  const Scale s{0x1p-10, 0x1p30};
  const Model model = models(2)[0];
  std::vector<double> energies[2], penalties[2];
  std::size_t which = 0;
  RunOptions options;
  options.progress = [&](const ProgressStep& step) {
    energies[which].push_back(step.energy);
    penalties[which].push_back(step.r);
  };
  Run plain = solved(2, model, {}, options);
  which = 1;
  Run run = solved(2, model, s, options);
  REQUIRE(energies[0].size() == energies[1].size());
  for (std::size_t i = 0; i < energies[0].size(); ++i) {
    CHECK(energies[1][i] == energies[0][i] * s.modulus * s.length * s.length);
    CHECK(penalties[1][i] == penalties[0][i] * s.modulus / s.length);
  }
  const SpectrumResult a = analyse_spectrum(plain.part, {}, {}).back(),
                       b = analyse_spectrum(run.part, {}, {}).back();
  CHECK(b.lambda_max == a.lambda_max * s.length / s.modulus);
  CHECK(b.bound_min == a.bound_min * s.length / s.modulus);
  CHECK(b.r_star == a.r_star * s.modulus / s.length);
  CHECK(active_penalty(run.part, run.solution, {}, {}).r ==
        active_penalty(plain.part, plain.solution, {}, {}).r * s.modulus / s.length);
}

TEST_CASE("loads may be as small as they like") {
  Model model = beam(3, elastic_law(1.0, 0.3), 1e-3);
  const Run plain = solved(3, model, {});
  for (const double share : {1e-20, 1e-38}) {
    CAPTURE(share);
    Model small = model;
    scale(*small.boundary[1].traction, share);
    const Run run = solved(3, small, {});
    CHECK(run.result().status == Status::converged);
    CHECK(run.result().cg_iterations == plain.result().cg_iterations);
    CHECK(run.probe()[2] / share == doctest::Approx(plain.probe()[2]).epsilon(1e-9));
  }
}

TEST_CASE("sizes and moduli beyond what doubles hold with their products are refused by name") {
  const Model model = models(3)[1];
  CHECK_THROWS_WITH_AS(solved(3, model, {1e-50, 1.0}), doctest::Contains("mesh: the size of the body is"),
                       InputError);
  CHECK_THROWS_WITH_AS(solved(3, model, {1e50, 1.0}), doctest::Contains("mesh: the size of the body is"),
                       InputError);
  CHECK_THROWS_WITH_AS(solved(3, model, {1.0, 1e-50}), doctest::Contains("material[0]: a modulus is"),
                       InputError);
  CHECK_THROWS_WITH_AS(solved(3, model, {1.0, 1e50}), doctest::Contains("material[0]: a modulus is"),
                       InputError);
}
