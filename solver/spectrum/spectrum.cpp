// SPDX-License-Identifier: BSD-3-Clause
// Lanczos estimates behind the penalty: r* and r_A of the active set, with bounds (theory: lanczos).
#include "spectrum/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {

Spectrum::Spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg, std::span<const double> g,
                   const SpectrumOptions& options)
    : part_(&part), op_(&op), amg_(&amg), g_(g), options_(options) {}

CgResult Spectrum::solve(const Space& space, std::span<double> x, CgWork& work, const TraceRows* penalised,
                         double r0) {
  Vector rows(penalised != nullptr ? penalised->owned() : 0), image(penalised != nullptr ? x.size() : 0);
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    double share = op_->apply(p, q);
    if (penalised == nullptr) return share;
    penalised->apply(p, rows);
    for (double& v : rows) {
      share += r0 * v * v;
      v *= r0;
    }
    penalised->transpose(rows, image);
    for (std::size_t i = 0; i < image.size(); ++i) q[i] += image[i];
    return share;
  };
  const auto precondition = [&](std::span<const double> r, std::span<double> z) { amg_->apply(r, z); };
  // Products good to a fiftieth of what is asked of the eigenvalue.
  const CgOptions options{0.0, std::max(1e-13, 0.02 * options_.tolerance), options_.max_cg};
  const CgResult result = conjugate_gradients(space, apply, precondition, x, work, options);
  cost_.cg_iterations += result.iterations;
  cost_.converged = cost_.converged && result.converged;
  return result;
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
  const Product product = [&](std::span<const double> x, std::span<double> y) {
    rows.transpose(x, work.residual);
    std::fill(u.begin(), u.end(), 0.0);
    solve(space, u, work, loose ? &rows : nullptr, r0);
    rows.apply(u, y);
  };
  LanczosOptions options;
  options.tolerance = options_.tolerance;
  // The largest compliance is well separated: four products give it to 1e-6.
  if (options_.tolerance >= 1e-3) options.basis = 3;
  if (!loose) {
    const auto found = largest_eigenvalues(product, rows.index(), mpi_of(part_->node_map), options);
    cost_.products += found.products;
    cost_.converged = cost_.converged && found.converged;
    if (found.values.empty()) return {};
    return {found.values[0], found.bounds[0]};
  }
  options.wanted = static_cast<int>(std::min<std::int64_t>(1 + part_->loose_modes, rows.total() - 1));
  if (options.wanted < 1) return {};
  const auto found = largest_eigenvalues(product, rows.index(), mpi_of(part_->node_map), options);
  cost_.products += found.products;
  cost_.converged = cost_.converged && found.converged;
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    const double theta = r0 * found.values[i];
    if (theta > 0.9999) continue;  // a rigid mode: λ is infinite
    return {found.values[i] / (1.0 - theta), found.bounds[i] / ((1.0 - theta) * (1.0 - theta))};
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
  // K⁻¹ x: the displacement with D^½ C u = x of least energy, and the force that holds it there.
  const Product product = [&](std::span<const double> x, std::span<double> y) {
    rows.lift(x, u);
    op_->apply(u, image);
    for (std::size_t i = 0; i < image.size(); ++i) work.residual[i] = -image[i];
    std::fill(delta.begin(), delta.end(), 0.0);
    solve(space, delta, work, nullptr, 0.0);
    op_->apply(delta, work.image);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] += work.image[i];
    rows.lift_transpose(image, y);
  };
  LanczosOptions options;
  options.tolerance = options_.tolerance;
  const auto found = largest_eigenvalues(product, rows.index(), mpi_of(part_->node_map), options);
  cost_.products += found.products;
  cost_.converged = cost_.converged && found.converged;
  if (found.values.empty() || !(found.values[0] > 0.0)) return {};
  const double largest = found.values[0];
  return {1.0 / largest, found.bounds[0] / (largest * largest)};
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
      // What the row takes of displacements like itself.
      if (part.contact.is_wide(i)) stiffness /= square * square;
      stiffest = std::max(stiffest, stiffness / point.mass);
    };
    look([](const RowEntry& entry) -> const Vector3& { return entry.trace; });
    for (std::size_t k = 0; friction && k < static_cast<std::size_t>(point.tangents); ++k)
      look([k](const RowEntry& entry) -> const Vector3& { return entry.tangent[k]; });
  }
  stiffest = part.node_map.max_all(stiffest);
  // With tangents a mode that shears and presses at once is softer: 1.6 on structured and Gmsh meshes alike.
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
  // r₀ λ_min = 0.01: compliances up to 10⁴ λ_min are told from the rigid modes.
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
