// SPDX-License-Identifier: BSD-3-Clause
// The dual form is ADMM without over-relaxation: the same iterates in every step (theory: dual-admm).
#include "contact/dual_admm.hpp"

#include <doctest/doctest.h>

#include "amg/make_preconditioner.hpp"
#include "linear/distributed_operator.hpp"
#include "spectrum/spectrum.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// The elastic beam with everything that the contact loops need.
struct Setting {
  Problem problem;
  Part part;
  Space space;
  Traces traces;
  DistributedOperator op;
  std::unique_ptr<Preconditioner> amg;
  LinearProblem linear;

  Setting(int dim, double gap, double tresca, const Penalty& r)
      : problem(make(dim, gap, tresca)),
        part(distribute(&problem, MPI_COMM_SELF)),
        space(part),
        traces(part),
        op(part, 1, ""),
        amg(make_preconditioner(SolverOptions(), part, 1, "")) {
    std::vector<double> secant(part.body().secant_count());
    op.local().secant(secant);
    const std::size_t points = part.contact.size();
    auto blocks = TraceRows(part, std::vector<TraceChoice>(points, {true, false})).penalty_blocks(r.normal);
    const auto more =
        TraceRows(part, std::vector<TraceChoice>(points, {false, true})).penalty_blocks(r.tangential);
    blocks.insert(blocks.end(), more.begin(), more.end());
    amg->setup(secant, blocks, space);
    linear = {&space, &traces,
              [this](std::span<const double> x, std::span<double> y) { return op.apply(x, y); },
              [this](std::span<const double> x, std::span<double> y) { amg->apply(x, y); }};
  }

  static Problem make(int dim, double gap, double tresca) {
    Model model = beam(dim, elastic_law(1.0, 0.3), 0.05, tresca);
    std::get<Plane>(model.contact[0].obstacle).point[dim - 1] = -gap;
    // A prescribed displacement that lifts the clamped end, which both loops must treat alike.
    (*model.boundary[0].displacement)[dim - 1] = 0.002;
    return build_problem(beam_mesh(dim, dim == 2 ? 6 : 2), model);
  }

  /// Returns the state with prescribed components of u, and multipliers that need not be zero.
  ContactState start(double pressure) const {
    ContactState state;
    const std::size_t points = part.contact.size();
    state.u.assign(part.unknowns(), 0.0);
    part.prescribe(state.u);
    state.trace = state.phi = state.lambda = ContactValues(points);
    state.bound.resize(points);
    traces.evaluate(state.u, state.trace);
    for (std::size_t i = 0; i < points; ++i) {
      state.bound[i] = part.contact[i].tresca;
      state.gap.push_back(part.contact[i].gap);
      state.phi.normal[i] = state.gap[i];
      if (i % 2 == 0) state.lambda.normal[i] = pressure;
    }
    return state;
  }

  /// Computes F − B u − CᵀMλ, which the loops expect on entry.
  void residual(const ContactState& state, CgWork& work) {
    work.resize(part.unknowns());
    op.apply(state.u, work.image);
    for (std::size_t i = 0; i < work.residual.size(); ++i) work.residual[i] = -work.image[i];
    part.add_load(work.residual);
    traces.add_force(state.lambda, -1.0, work.residual);
  }
};

double largest(const Vector& x) {
  double most = 0.0;
  for (const double v : x) most = std::max(most, std::abs(v));
  return most;
}

double difference(const Vector& a, const Vector& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("every iterate of the dual form is that of ADMM, with exact and with inexact solves") {
  for (const int dim : {2, 3})
    for (const double tresca : {0.0, 0.01})
      for (const double pressure : {0.0, 0.02}) {
        const Penalty r{2.0, 0.7};
        Setting setting(dim, 0.01, tresca, r);
        const Vector volume(setting.part.nodes(), 1.0);
        for (const bool exact : {true, false})
          for (const int iterations : {1, 2, 3, 5, 9, 14}) {
            CAPTURE(dim);
            CAPTURE(tresca);
            CAPTURE(pressure);
            CAPTURE(exact);
            CAPTURE(iterations);
            AdmmOptions options;
            options.r = r;
            options.max_iterations = iterations;
            if (exact) {
              options.step_tolerance = 1e-300;  // solves to 1e-12, and never stops before max_iterations
              options.volume = volume;
            }
            ContactState one = setting.start(pressure), two = one;
            CgWork work;
            setting.residual(one, work);
            const AdmmResult first = admm(setting.linear, one, work, options);
            setting.residual(two, work);
            const AdmmResult second = dual_admm(setting.linear, two, work, options);
            CHECK(first.iterations == iterations);
            CHECK(second.iterations == iterations);
            const double u = largest(one.u), p = largest(one.lambda.normal);
            CHECK(difference(one.u, two.u) < 1e-8 * u);
            CHECK(difference(one.phi.normal, two.phi.normal) < 1e-8 * u);
            CHECK(difference(one.phi.tangential, two.phi.tangential) < 1e-8 * u);
            CHECK(difference(one.lambda.normal, two.lambda.normal) < 1e-8 * p);
            CHECK(difference(one.lambda.tangential, two.lambda.tangential) < 1e-8 * p);
            // The same solves, each over a hundred iterations long, whose length rounding changes by one or
            // two.
            CHECK(std::abs(static_cast<double>(second.cg_iterations - first.cg_iterations)) <=
                  0.02 * static_cast<double>(first.cg_iterations));
            CHECK(second.trace_residual == doctest::Approx(first.trace_residual).epsilon(1e-6).scale(u));
            CHECK(second.force_residual == doctest::Approx(first.force_residual).epsilon(1e-6));
            if (exact) CHECK(second.step == doctest::Approx(first.step).epsilon(1e-6));
          }
      }
}

TEST_CASE("whole runs of both take the same iterations, also when the stop by steps ends them") {
  for (const auto stop : {SolverOptions::Stop::kkt, SolverOptions::Stop::paper})
    for (const double tresca : {0.0, 0.01}) {
      CAPTURE(static_cast<int>(stop));
      CAPTURE(tresca);
      Model model = beam(2, logarithmic_law(0.01), 0.05, tresca);
      model.solver.outer = SolverOptions::Outer::kacanov;
      model.solver.penalty = SolverOptions::Penalty::paper;
      model.solver.relaxation = 1.0;
      model.solver.stop = stop;
      model.solver.tolerance = stop == SolverOptions::Stop::kkt ? 1e-6 : 1e-4;
      model.solver.contact = SolverOptions::Contact::admm;
      const Run one = run_alone(beam_mesh(2, 4), model);
      model.solver.contact = SolverOptions::Contact::dual_admm;
      const Run two = run_alone(beam_mesh(2, 4), model);
      if (stop == SolverOptions::Stop::kkt) CHECK(two.result().status == Status::converged);
      CHECK(two.result().outer_iterations == one.result().outer_iterations);
      CHECK(two.result().contact_iterations == one.result().contact_iterations);
      CHECK(distance(one.probe(), two.probe()) < 1e-7 * length(one.probe()));
    }
}
