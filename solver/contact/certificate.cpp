// SPDX-License-Identifier: BSD-3-Clause
// The KKT residuals of a state, relative to scales that the state itself sets.
#include "contact/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kacanov {

double Certificate::worst() const noexcept {
  double w = 0.0;
  for (const double v :
       {equilibrium, penetration, tension, complementarity, friction_cone, force_balance, duality_gap})
    w = std::isfinite(v) ? std::max(w, v) : HUGE_VAL;
  return w;
}

namespace {

/// Share of ‖diag(B) ∘ ω‖ below which a force is none to measure others by.
constexpr double rounding = 1e-9;
/// Share of it, and of ω·diag(B) ω, that the rounding of R(ω) alone comes to (measured: 1e-16): no residual.
/// Matters where a body moves without strain, and a tolerance below 1e-6 of nothing is asked for.
constexpr double noise = 1e-15;

double without(double value, double noise_of_it) { return std::max(0.0, value - noise_of_it); }

/// Products and extremes over the contact points.
struct ContactSums {
  double normal_product = 0.0;    // Σ M λ_n |Nω − ρ|
  double friction_product = 0.0;  // Σ M | ψ|Tω| − λ_f·Tω |
  double dual_work = 0.0;  // Σ M (λ_n (ρ − Nω) + ψ|Tω| − λ_f·Tω), the contact part of the duality gap
  double area = 0.0, force = 0.0;
  double penetration = 0.0, tension = 0.0, cone = 0.0, pressure = 0.0;
};

ContactSums contact_sums(const Traces& traces, const ContactState& state) {
  ContactSums s;
  const auto points = traces.points().first(traces.owned());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    const double lambda = state.lambda.normal[i], open = state.gap[i] - state.trace.normal[i];
    const double* slip = &state.trace.tangential[2 * i];
    const double* friction = &state.lambda.tangential[2 * i];
    s.normal_product += point.mass * std::abs(lambda * open);
    s.dual_work += point.mass * lambda * open;
    s.area += point.mass;
    s.penetration = std::max(s.penetration, -open);
    s.tension = std::max(s.tension, -lambda);
    s.pressure = std::max(s.pressure, std::abs(lambda));
    if (point.tangents == 0) continue;
    const double bound = state.bound[i], length = std::hypot(friction[0], friction[1]);
    const double product =
        bound * std::hypot(slip[0], slip[1]) - friction[0] * slip[0] - friction[1] * slip[1];
    s.friction_product += point.mass * std::abs(product);
    s.dual_work += point.mass * product;
    s.cone = std::max(s.cone, length - bound);
    s.pressure = std::max(s.pressure, length);
  }
  std::array<double, 4> sums{s.normal_product, s.friction_product, s.dual_work, s.area};
  const Halo& halo = traces.halo();
  halo.sum_all(sums);
  s.normal_product = sums[0];
  s.friction_product = sums[1];
  s.dual_work = sums[2];
  s.area = sums[3];
  s.penetration = halo.max_all(s.penetration);
  s.tension = halo.max_all(s.tension);
  s.cone = halo.max_all(s.cone);
  s.pressure = halo.max_all(s.pressure);
  return s;
}

}  // namespace

Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        const BodyForces& forces) {
  const Part& part = space.part();
  const auto [load_entries, internal, energy, diagonal] = forces;
  const auto dim = static_cast<std::size_t>(part.dim());
  Vector contact(part.unknowns(), 0.0);
  traces.add_force(state.lambda, 1.0, contact);
  const ContactSums sums = contact_sums(traces, state);

  Residuals out;
  out.energy = energy;
  Scales& scales = out.scales;
  // Sums of forces: the load, the obstacles, the supports; what they work; squares of their norms.
  std::array<double, 12> totals{};  // three balances, Σ|force|, ω·residual, ω·R, |·|²: residual, reaction,
                                    // contact, load, stiff; ω·stiff
  auto loaded = load_entries.begin();
  for (std::size_t i = 0; i < part.owned_unknowns(); ++i) {
    const bool here = loaded != load_entries.end() && static_cast<std::size_t>(loaded->component) == i;
    const double load = here ? (loaded++)->value : 0.0;
    const double unbalanced = load - internal[i] - contact[i],
                 stiff = rounding * static_cast<double>(diagonal[i]) * state.omega[i];
    const double reaction = part.held[i] ? -unbalanced : 0.0, residual = part.held[i] ? 0.0 : unbalanced;
    totals[i % dim] += load - contact[i] + reaction;
    totals[3] += std::abs(load) + std::abs(contact[i]) + std::abs(reaction);
    totals[4] += residual * state.omega[i];
    totals[5] += internal[i] * state.omega[i];
    totals[6] += residual * residual;
    totals[7] += reaction * reaction;
    totals[8] += contact[i] * contact[i];
    totals[9] += load * load;
    totals[10] += stiff * stiff;
    totals[11] += stiff * state.omega[i];
  }
  part.halo.sum_all(totals);
  const double stiff_force = totals[10], stiff_energy = totals[11];
  scales.force = std::sqrt(*std::max_element(totals.begin() + 7, totals.begin() + 11));
  scales.displacement = space.max_abs(state.omega);

  const double tiny = 1e-300;
  scales.pressure = std::max(sums.pressure, sums.area > 0.0 ? 0.5 * totals[3] / sums.area * 1e-3 : 0.0);
  const double force = std::max(scales.force, tiny), displacement = std::max(scales.displacement, tiny);
  const double pressure = std::max(scales.pressure, tiny);
  Certificate& c = out.certificate;
  const double force_noise = noise / rounding * std::sqrt(stiff_force),
               energy_noise = noise / rounding * stiff_energy;
  c.equilibrium = without(std::sqrt(totals[6]), force_noise) / force;
  c.penetration = std::max(0.0, sums.penetration) / displacement;
  c.tension = std::max(0.0, sums.tension) / pressure;
  c.friction_cone = std::max(0.0, sums.cone) / pressure;
  c.complementarity =
      (sums.normal_product + sums.friction_product) / std::max(pressure * displacement * sums.area, tiny);
  c.force_balance =
      without(std::sqrt(totals[0] * totals[0] + totals[1] * totals[1] + totals[2] * totals[2]), force_noise) /
      std::max({totals[3], std::sqrt(stiff_force), tiny});
  // Primal minus dual energy. With τ = τ(ω) the stored energies add up to R·ω, and
  // what is left is the work of the equilibrium residual and the contact products.
  c.duality_gap = without(std::abs(sums.dual_work - totals[4]), energy_noise) /
                  std::max({energy, 0.5 * std::abs(totals[5]), stiff_energy, tiny});
  return out;
}

}  // namespace kacanov
