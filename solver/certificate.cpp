// SPDX-License-Identifier: BSD-3-Clause
// The KKT residuals of a state, relative to scales that the state itself sets.
#include "certificate.hpp"

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
/// Share of it, and of ω·diag(B) ω, that the rounding of R(ω) alone comes to (measured: 1e-16): no residual. Matters where a
/// body moves without strain, and a tolerance below 1e-6 of nothing is asked for.
constexpr double noise = 1e-15;

double without(double value, double noise_of_it) { return std::max(0.0, value - noise_of_it); }

/// Products and extremes over the contact points.
struct ContactSums {
  double normal_product = 0.0;    // Σ M λ_n |Nω − ρ|
  double friction_product = 0.0;  // Σ M | ψ|Tω| − λ_f·Tω |
  double dual_work = 0.0;         // Σ M (λ_n (ρ − Nω) + ψ|Tω| − λ_f·Tω), the contact part of the duality gap
  double area = 0.0, force = 0.0;
  double penetration = 0.0, tension = 0.0, cone = 0.0, pressure = 0.0;
};

ContactSums contact_sums(const Traces& traces, const ContactState& state) {
  ContactSums s;
  const auto points = traces.points().first(traces.owned());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    const double lambda = state.lambda.normal[i], open = point.gap - state.trace.normal[i];
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
    const double product = bound * std::hypot(slip[0], slip[1]) - friction[0] * slip[0] - friction[1] * slip[1];
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
                        std::span<const double> internal, double energy, std::span<const double> diagonal) {
  const Part& part = space.part();
  const auto dim = static_cast<std::size_t>(part.dim());
  const std::size_t n = part.unknowns();
  Vector contact(n, 0.0), residual(n), reaction(n, 0.0);
  traces.add_force(state.lambda, 1.0, contact);
  for (std::size_t i = 0; i < n; ++i) residual[i] = part.load[i] - internal[i] - contact[i];
  for (std::size_t i = 0; i < n; ++i)
    if (part.held[i]) {
      reaction[i] = -residual[i];
      residual[i] = 0.0;
    }
  const ContactSums sums = contact_sums(traces, state);

  Residuals out;
  out.energy = energy;
  const double contact_norm = space.norm(contact), reaction_norm = space.norm(reaction);
  Scales& scales = out.scales;
  Vector stiff(n);
  for (std::size_t i = 0; i < n; ++i) stiff[i] = rounding * diagonal[i] * state.omega[i];
  const auto [stiff_force, stiff_energy] = space.dot2(stiff, stiff, stiff, state.omega);
  scales.force = std::max({space.norm(part.load), reaction_norm, contact_norm, std::sqrt(stiff_force)});
  scales.displacement = space.max_abs(state.omega);

  // Sums of forces: the load, the obstacles, the supports; and what the supports work on.
  std::array<double, 6> totals{};  // three balances, Σ|force|, ω·residual, ω_D·reaction
  for (std::size_t i = 0; i < part.owned_unknowns(); ++i) {
    totals[i % dim] += part.load[i] - contact[i] + reaction[i];
    totals[3] += std::abs(part.load[i]) + std::abs(contact[i]) + std::abs(reaction[i]);
    totals[4] += residual[i] * state.omega[i];
    totals[5] += internal[i] * state.omega[i];
  }
  part.halo.sum_all(totals);

  const double tiny = 1e-300;
  scales.pressure = std::max(sums.pressure, sums.area > 0.0 ? 0.5 * totals[3] / sums.area * 1e-3 : 0.0);
  const double force = std::max(scales.force, tiny), displacement = std::max(scales.displacement, tiny);
  const double pressure = std::max(scales.pressure, tiny);
  Certificate& c = out.certificate;
  const double force_noise = noise / rounding * std::sqrt(stiff_force), energy_noise = noise / rounding * stiff_energy;
  c.equilibrium = without(space.norm(residual), force_noise) / force;
  c.penetration = std::max(0.0, sums.penetration) / displacement;
  c.tension = std::max(0.0, sums.tension) / pressure;
  c.friction_cone = std::max(0.0, sums.cone) / pressure;
  c.complementarity = (sums.normal_product + sums.friction_product) /
                      std::max(pressure * displacement * sums.area, tiny);
  c.force_balance = without(std::sqrt(totals[0] * totals[0] + totals[1] * totals[1] + totals[2] * totals[2]), force_noise) /
                    std::max({totals[3], std::sqrt(stiff_force), tiny});
  // Primal minus dual energy. With τ = τ(ω) the stored energies add up to R·ω, and
  // what is left is the work of the equilibrium residual and the contact products.
  c.duality_gap = without(std::abs(sums.dual_work - totals[4]), energy_noise) / std::max({energy, 0.5 * std::abs(totals[5]), stiff_energy, tiny});
  return out;
}

}  // namespace kacanov
