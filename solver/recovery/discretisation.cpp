// SPDX-License-Identifier: BSD-3-Clause
// Estimate of the discretisation error, and nodal stress from the same polynomials.
#include <kacanov/discretisation.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "linear/reference_response.hpp"
#include "recovery/spr_patches.hpp"

namespace kacanov {
namespace {

DiscretisationError error_from(const Part& part, const BodyState& state, std::vector<double> of_element) {
  DiscretisationError error;
  error.element = std::move(of_element);
  double sum = 0.0;
  for (const double one : error.element) sum += one;
  error.energy = part.node_map.sum_all(sum);
  Body body = part.body();
  body.corner_dilatation = state.corner_dilatation;
  error.stored = part.node_map.sum_all(stored_energy(body, state.u));
  if (const std::vector<double> longer = free_strain(part, state.thermal); part.plane == PlaneState::stress) {
    body.free_strain = longer;
    error.stored = std::max(error.stored, part.node_map.sum_all(stored_energy(body, state.u)));
  }
  if (error.stored > 0.0) error.relative = std::sqrt(error.energy / error.stored);
  return error;
}

/// Results to compute from the patch polynomials.
struct Wanted {
  bool stress = false, error = false;
};

/// Processes one batch of materials at a time; materials of a batch share no node.
Recovered recover(const Part& part, const BodyState& state, Wanted wanted) {
  const Patches patches(part);
  const std::size_t elements = part.element_count(), points = points_per_element(part.type);
  const std::size_t error_set = wanted.stress ? 1 : 0;
  StressRecovery recovery(part, patches);
  std::vector<double> energy(wanted.error ? elements : 0), mean_trace(energy.size());
  const std::vector<double> longer = free_strain(part, state.thermal);
  const PointValues values = wanted.stress ? PointValues::all : PointValues::all_but_stress;
  for (std::int32_t batch = 0; batch < patches.batches(); ++batch) {
    PatchFits fits = patches.fits(error_set + (wanted.error ? 1 : 0));
    visit_points(part, state, values, [&](const PointRun& run) {
      for (std::size_t k = 0; k < run.volume.size(); k += points) {
        const std::size_t e = run.first + k / points;
        if (!patches.is_in(e, batch)) continue;
        const double *strain = &run.strain[6 * k], *stress = wanted.stress ? &run.stress[6 * k] : strain;
        patches.add(fits, e, {std::span(run.position).subspan(k, points), {stress, strain}});
        if (wanted.error) mean_trace[e] = strain[0] + strain[1] + strain[2];
      }
    });
    patches.solve(fits);
    if (wanted.stress) recovery.take(fits, 0, batch);
    if (wanted.error)
      error_loop(part.type)({part, state, patches, fits, error_set, mean_trace, longer}, batch, energy);
  }
  Recovered out;
  if (wanted.stress) out.nodal = recovery.result();
  if (wanted.error) out.error = error_from(part, state, std::move(energy));
  return out;
}

}  // namespace

NodalStress recover_stress(const Part& part, const BodyState& state) {
  return recover(part, state, {.stress = true}).nodal;
}

DiscretisationError estimate_error(const Part& part, const BodyState& state) {
  return recover(part, state, {.error = true}).error;
}

Recovered recover_and_estimate(const Part& part, const BodyState& state) {
  return recover(part, state, {.stress = true, .error = true});
}

std::vector<double> DiscretisationError::shares() const {
  std::vector<double> all = element;
  for (double& share : all) share = stored > 0.0 ? std::sqrt(share / stored) : 0.0;
  return all;
}

std::optional<double> error_of_last(std::span<const double> values) {
  // By default the error falls by a factor of 4 per halving (order 2, smooth solution, straight elements).
  // Three values give the observed factor, which is limited to the range 2 to 16.
  const std::size_t n = values.size();
  if (n < 2) return std::nullopt;
  const double last = std::abs(values[n - 1] - values[n - 2]);
  double ratio = 4.0;
  if (n > 2 && last > 0.0) ratio = std::clamp(std::abs(values[n - 2] - values[n - 3]) / last, 2.0, 16.0);
  return last / (ratio - 1.0);
}

}  // namespace kacanov
