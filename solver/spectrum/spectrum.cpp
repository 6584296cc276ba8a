// SPDX-License-Identifier: BSD-3-Clause
// Lanczos estimates for the penalty: r*, and r_A of an active set, with bounds (theory: lanczos).
#include "spectrum/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

/// Rounding error of a product, relative to the eigenvalue.
constexpr double rounded_product = 1e-12;

/// Upper bound of the largest eigenvalue, which Ritz values approach from below.
double bound_above(const LanczosResult& found) { return 1.2 * (found.values[0] + found.bounds[0]); }

}  // namespace

Spectrum::Spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg, std::span<const double> g,
                   const SpectrumOptions& options)
    : part_(&part), op_(&op), amg_(&amg), g_(g), options_(options) {}

double Spectrum::apply(const System& system, std::span<const double> p, std::span<double> q) {
  double share = op_->apply(p, q);
  if (system.penalised == nullptr) return share;
  Vector rows(system.penalised->owned()), image(q.size());
  system.penalised->apply(p, rows);
  for (double& v : rows) {
    share += system.r0 * v * v;
    v *= system.r0;
  }
  system.penalised->transpose(rows, image);
  for (std::size_t i = 0; i < image.size(); ++i) q[i] += image[i];
  return share;
}

CgResult Spectrum::solve_to(const System& system, std::span<double> x, CgWork& work, double relative) {
  const auto product = [&](std::span<const double> p, std::span<double> q) { return apply(system, p, q); };
  const auto precondition = [&](std::span<const double> r, std::span<double> z) { amg_->apply(r, z); };
  const CgOptions options{0.0, relative, options_.max_cg};
  const CgResult result = conjugate_gradients(system.space, product, precondition, x, work, options);
  cost_.cg_iterations += result.iterations;
  cost_.converged = cost_.converged && result.converged;
  return result;
}

double Spectrum::solve(const System& system, std::span<double> x, CgWork& work, Accuracy accuracy) {
  // A product is fifty times as accurate as the required eigenvalue.
  const double relative = std::max(1e-13, 0.02 * options_.tolerance);
  if (accuracy == Accuracy::product) {
    solve_to(system, x, work, relative);
    return 0.0;
  }
  const Vector right = work.residual;
  solve_to(system, x, work, std::max(1e-13, 0.1 * relative));
  // The change by further iterations bounds the previous error, including the rounding of the residual.
  apply(system, x, work.image);
  for (std::size_t i = 0; i < right.size(); ++i) work.residual[i] = right[i] - work.image[i];
  return std::sqrt(std::max(solve_to(system, x, work, 0.01).energy, 0.0));
}

LanczosResult Spectrum::largest_of(const Product& product, const TraceRows& rows,
                                   const LanczosOptions& options) {
  LanczosResult found = largest_eigenvalues(product, rows.index(), mpi_of(part_->node_map), options);
  cost_.products += found.products;
  cost_.converged = cost_.converged && found.converged;
  return found;
}

Eigenvalue Spectrum::bounded(const LanczosResult& found, std::size_t i, const BoundedProduct& product,
                             double gain) {
  if (i >= found.vectors.size()) return {found.values[i], found.bounds[i]};  // not converged
  const std::vector<double>& v = found.vectors[i];
  std::vector<double> y(v.size());
  const double error = product(v, y);
  ++cost_.products;
  const auto dot = [&](std::span<const double> a, std::span<const double> b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return part_->node_map.sum_all(sum);
  };
  const double square = dot(v, v), value = dot(v, y) / square;
  for (std::size_t k = 0; k < y.size(); ++k) y[k] -= value * v[k];
  return {value, std::sqrt(dot(y, y) / square) + gain * error / std::sqrt(square) + rounded_product * value};
}

Eigenvalue Spectrum::largest(const TraceRows& rows, const TraceRows& held, double r0, bool loose) {
  Space space(*part_);
  held.hold_in(space);
  auto blocks = held.pinning_blocks(op_->diagonal());
  if (loose) {
    const auto more = rows.penalty_blocks(r0);
    blocks.insert(blocks.end(), more.begin(), more.end());
  }
  amg_->setup(g_, blocks, space);

  CgWork work;
  work.resize(part_->unknowns());
  Vector u(part_->unknowns());
  const System system{space, loose ? &rows : nullptr, r0};
  const auto product = [&](std::span<const double> x, std::span<double> y, Accuracy accuracy) {
    rows.transpose(x, work.residual);
    std::fill(u.begin(), u.end(), 0.0);
    const double error = solve(system, u, work, accuracy);
    rows.apply(u, y);
    return error;
  };
  LanczosOptions options;
  options.tolerance = options_.tolerance;
  // The largest compliance is well separated: four products give it to 1e-6.
  if (options_.tolerance >= 1e-3) options.basis = 3;
  if (loose)
    options.wanted = static_cast<int>(std::min<std::int64_t>(1 + part_->loose_modes, rows.total() - 1));
  if (options.wanted < 1) return {};
  const LanczosResult found =
      largest_of([&](std::span<const double> x, std::span<double> y) { product(x, y, Accuracy::product); },
                 rows, options);
  if (found.values.empty()) return {};
  // A product is C times a displacement; this is the longest trace of a displacement of energy norm 1.
  const double gain = std::sqrt(bound_above(found));
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    if (loose && r0 * found.values[i] > 0.9999) continue;  // a rigid-body mode: λ is infinite
    const Eigenvalue pair = bounded(
        found, i,
        [&](std::span<const double> x, std::span<double> y) { return product(x, y, Accuracy::bounded); },
        gain);
    if (!loose) return pair;
    // λ = θ/(1 − r₀θ) is convex and increasing in θ.
    const double value = pair.value / (1.0 - r0 * pair.value), left = 1.0 - r0 * (pair.value + pair.bound);
    return {value, left > 0.0 ? (pair.value + pair.bound) / left - value : HUGE_VAL};
  }
  return {};
}

Eigenvalue Spectrum::smallest(const TraceRows& rows) {
  Space space(*part_);
  rows.hold_in(space);
  amg_->setup(g_, rows.pinning_blocks(op_->diagonal()), space);

  CgWork work;
  work.resize(part_->unknowns());
  Vector u(part_->unknowns()), delta(part_->unknowns()), image(part_->unknowns());
  const System system{space};
  // K⁻¹ x: the displacement with D^½ C u = x of minimum energy, and the force that holds it.
  const auto product = [&](std::span<const double> x, std::span<double> y, Accuracy accuracy) {
    rows.lift(x, u);
    op_->apply(u, image);
    for (std::size_t i = 0; i < image.size(); ++i) work.residual[i] = -image[i];
    std::fill(delta.begin(), delta.end(), 0.0);
    const double error = solve(system, delta, work, accuracy);
    op_->apply(delta, work.image);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] += work.image[i];
    rows.lift_transpose(image, y);
    return error;
  };
  LanczosOptions options;
  options.tolerance = options_.tolerance;
  const LanczosResult found =
      largest_of([&](std::span<const double> x, std::span<double> y) { product(x, y, Accuracy::product); },
                 rows, options);
  if (found.values.empty() || !(found.values[0] > 0.0)) return {};
  // Traces lifted to the contact nodes alone have the largest energy that a trace of length 1 can have.
  options.tolerance = 0.1;
  const Product unrelaxed = [&](std::span<const double> x, std::span<double> y) {
    rows.lift(x, u);
    op_->apply(u, image);
    rows.lift_transpose(image, y);
  };
  const double gain =
      std::sqrt(bound_above(largest_eigenvalues(unrelaxed, rows.index(), mpi_of(part_->node_map), options)));
  const Eigenvalue inverse = bounded(
      found, 0,
      [&](std::span<const double> x, std::span<double> y) { return product(x, y, Accuracy::bounded); }, gain);
  const double value = 1.0 / inverse.value, left = inverse.value - inverse.bound;
  return {value, left > 0.0 ? 1.0 / left - value : HUGE_VAL};
}

double rough_lambda_min(const Part& part, std::span<const float> diagonal, bool friction) {
  const std::size_t dim = part.dim();
  double stiffest = 0.0;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    const auto& point = part.contact[i];
    const auto look = [&](const auto& row) {
      double stiffness = 0.0, square = 0.0;
      for (const RowEntry& entry : part.contact.entries(i))
        for (std::size_t c = 0; c < dim; ++c) {
          const double weight = row(entry)[c] * row(entry)[c];
          stiffness += weight * static_cast<double>(diagonal[static_cast<std::size_t>(entry.node) * dim + c]);
          square += weight;
        }
      // Ratio for a displacement proportional to the row.
      if (part.contact.is_wide(i)) stiffness /= square * square;
      stiffest = std::max(stiffest, stiffness / point.mass);
    };
    look([](const RowEntry& entry) -> const Vector3& { return entry.trace; });
    for (std::size_t k = 0; friction && k < static_cast<std::size_t>(point.tangents); ++k)
      look([k](const RowEntry& entry) -> const Vector3& { return entry.tangent[k]; });
  }
  stiffest = part.node_map.max_all(stiffest);
  // With tangents, a mode that combines shear and pressure is softer: factor 1.6 on structured and Gmsh
  // meshes alike.
  return stiffest > 0.0 ? 1.0 / (friction ? 1.6 * stiffest : stiffest) : 0.0;
}

double rough_lambda_max(const Part& part, DistributedOperator& op, Preconditioner& amg, const TraceRows& rows,
                        const TraceRows& held, int steps) {
  Space space(part);
  held.hold_in(space);
  CgWork work;
  work.resize(part.unknowns());
  Vector trace(rows.owned()), u(part.unknowns(), 0.0);
  for (std::size_t i = 0; i < trace.size(); ++i) trace[i] = rows.root_mass()[i];
  rows.transpose(trace, work.residual);
  space.project(work.residual);
  const Vector force = work.residual;
  const auto apply = [&](std::span<const double> p, std::span<double> q) { return op.apply(p, q); };
  const auto precondition = [&](std::span<const double> r, std::span<double> z) { amg.apply(r, z); };
  conjugate_gradients(space, apply, precondition, u, work, CgOptions{0.0, 0.3, steps});
  // B u = force − residual.
  rows.apply(u, trace);
  double square = 0.0;
  for (const double v : trace) square += v * v;
  const double energy = space.dot(u, force) - space.dot(u, work.residual);
  square = part.node_map.sum_all(square);
  return energy > 0.0 ? square / energy : 0.0;
}

SpectrumResult estimate_spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg,
                                 std::span<const double> g, bool friction, const SpectrumOptions& options) {
  const double start = MPI_Wtime();
  const auto applications = op.applications();
  const std::vector<TraceChoice> all(part.contact.size(), {true, friction}), none(part.contact.size());
  const TraceRows rows(part, all), held(part, none);
  Spectrum spectrum(part, op, amg, g, options);
  SpectrumResult result;
  result.friction = friction;
  result.traces = rows.total();
  const Eigenvalue low = spectrum.smallest(rows);
  // r₀ λ_min = 0.01 separates compliances up to 10⁴ λ_min from the rigid-body modes.
  const Eigenvalue high =
      spectrum.largest(rows, held, low.value > 0.0 ? 0.01 / low.value : 1.0, part.loose_modes > 0);
  result.lambda_min = low.value;
  result.bound_min = low.bound;
  result.lambda_max = high.value;
  result.bound_max = high.bound;
  if (low.value > 0.0)
    result.r_star = 1.0 / std::sqrt(low.value * (high.value > 0.0 ? high.value : low.value));
  result.converged = spectrum.cost().converged;
  result.products = spectrum.cost().products;
  result.cg_iterations = spectrum.cost().cg_iterations;
  result.operator_applications = op.applications() - applications;
  result.seconds = MPI_Wtime() - start;
  return result;
}

}  // namespace kacanov
