// SPDX-License-Identifier: BSD-3-Clause
// The KKT residuals of a state, relative to scales that the state itself sets.
#include "contact/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "linear/springs.hpp"
#include "problem/vector3.hpp"

namespace kacanov {

namespace {

/// The larger of the two; infinite where one is no number (std::max may lose it).
double larger(double a, double b) { return std::isnan(a) || std::isnan(b) ? HUGE_VAL : std::max(a, b); }

}  // namespace

double KktResiduals::worst() const noexcept {
  double w = 0.0;
  for (const auto& [name, entry] : residual_names) w = larger(w, this->*entry);
  return w;
}

bool Certificate::meets(double tolerance) const noexcept {
  return std::all_of(residual_names.begin(), residual_names.end(), [&](const NamedResidual& one) {
    return this->*one.member + rounding.*one.member <= tolerance;
  });
}

bool Certificate::exhausted(double tolerance) const noexcept {
  return std::all_of(residual_names.begin(), residual_names.end(), [&](const NamedResidual& one) {
    const double residual = this->*one.member, unknown = rounding.*one.member;
    return residual <= unknown || residual + unknown <= tolerance;
  });
}

namespace {

/// Forces below this share of the harmonic mean of D times ‖u‖ are none to measure others by: of that mean,
/// because a part as stiff as rigid would else make any force look small.
constexpr double least_force = 3e-9;
/// Share of D∘u, and of u·(D∘u), that the rounding of R(u) may come to: nine units of it, because a row of B
/// is a few times its diagonal (measured: up to 5.4e-16); and of traces and gaps, which are short sums.
constexpr double rounding = 1e-15, rounding_of_traces = 3e-16;

/// Products and extremes over the contact points.
struct ContactSums {
  double normal_product = 0.0;    // Σ M λ_n |Nu − ρ|
  double friction_product = 0.0;  // Σ M | ψ|Tu| − λ_t·Tu |
  double dual_work = 0.0;  // Σ M (λ_n (ρ − Nu) + ψ|Tu| − λ_t·Tu), the contact part of the duality gap
  double area = 0.0, force = 0.0;
  double penetration = 0.0, tension = 0.0, cone = 0.0, pressure = 0.0;
  double unknown_trace = 0.0, unknown_product = 0.0;  // what rounding leaves of a gap, and of Σ M λ times it
};

/// `displacement`: max |u|. A trace is known to the rounding of the displacements that it is taken of,
/// however small it is beside them.
ContactSums contact_sums(const Traces& traces, const ContactState& state, double displacement) {
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
    s.penetration = larger(s.penetration, -open);
    s.tension = larger(s.tension, -lambda);
    s.pressure = larger(s.pressure, std::abs(lambda));
    // A point that is open by more than that is open, and not its own residual.
    const double unknown = rounding_of_traces * (displacement + std::abs(state.gap[i])) + point.unknown_gap;
    if (open <= unknown) s.unknown_trace = larger(s.unknown_trace, unknown);
    s.unknown_product += point.mass * std::abs(lambda) * unknown;
    if (point.tangents == 0) continue;
    const double bound = state.bound[i], length = std::hypot(friction[0], friction[1]);
    const double slid = std::hypot(slip[0], slip[1]);
    const double product = bound * slid - friction[0] * slip[0] - friction[1] * slip[1];
    s.friction_product += point.mass * std::abs(product);
    s.unknown_product += point.mass * (bound + length) * rounding_of_traces * (displacement + slid);
    s.dual_work += point.mass * product;
    s.cone = larger(s.cone, length - bound);
    s.pressure = larger(s.pressure, length);
  }
  const Communicator& ranks = traces.ranks();
  ranks.sum_each({&s.normal_product, &s.friction_product, &s.dual_work, &s.area, &s.unknown_product});
  s.penetration = ranks.max_all(s.penetration);
  s.tension = ranks.max_all(s.tension);
  s.cone = ranks.max_all(s.cone);
  s.pressure = ranks.max_all(s.pressure);
  s.unknown_trace = ranks.max_all(s.unknown_trace);
  return s;
}

/// Sums over the unknowns: forces of the load, the obstacles and the supports, and what they work.
struct BodySums {
  std::array<double, 3> balance{};  // the sum of all forces
  double all = 0.0;                 // Σ |force|
  double residual_work = 0.0, internal_work = 0.0;
  double residual = 0.0, reaction = 0.0, contact = 0.0, load = 0.0;  // squares of norms
  double moved = 0.0, stiff = 0.0, stiff_work = 0.0;                 // |u|², |D∘u|², u·(D∘u)
  double moved_all = 0.0, stiff_all = 0.0;                           // Σ |u|, Σ |D∘u|
  double softness = 0.0;                                             // mean of 1/D
};

/// What supports along directions do to the body, one an unknown: the share of F − R − CᵀMλ along them, with
/// its sign changed. Empty where there are none.
Vector slanting_reactions(const Part& part, std::span<const double> contact, const BodyForces& forces) {
  Vector reaction;
  if (part.directions.empty()) return reaction;
  const std::size_t dim = part.dim();
  reaction.assign(part.unknowns(), 0.0);
  Vector unbalanced(part.unknowns());
  for (std::size_t i = 0; i < unbalanced.size(); ++i) unbalanced[i] = -forces.internal[i] - contact[i];
  for (const Part::ComponentValue& load : forces.load) unbalanced[load.component] += load.value;
  for (const HeldDirection& held : part.directions) {
    double along = 0.0;
    for (std::size_t c = 0; c < dim; ++c) along += held.direction[c] * unbalanced[held.node * dim + c];
    for (std::size_t c = 0; c < dim; ++c) reaction[held.node * dim + c] -= along * held.direction[c];
  }
  return reaction;
}

/// Over all ranks; `contact` is CᵀMλ.
BodySums body_sums(const Part& part, std::span<const double> u, std::span<const double> contact,
                   const BodyForces& forces) {
  const std::size_t dim = part.dim();
  BodySums s;
  const Vector slanting = slanting_reactions(part, contact, forces);
  auto loaded = forces.load.begin();
  for (std::size_t i = 0; i < part.owned_unknowns(); ++i) {
    const bool here = loaded != forces.load.end() && static_cast<std::size_t>(loaded->component) == i;
    const double load = here ? (loaded++)->value : 0.0, diagonal = static_cast<double>(forces.diagonal[i]);
    const double unbalanced = load - forces.internal[i] - contact[i], stiff = diagonal * u[i];
    const double along = slanting.empty() ? 0.0 : slanting[i];
    const double reaction = part.held[i] ? -unbalanced : along,
                 residual = part.held[i] ? 0.0 : unbalanced + along;
    s.balance[i % dim] += load - contact[i] + reaction;
    s.all += std::abs(load) + std::abs(contact[i]) + std::abs(reaction);
    s.residual_work += residual * u[i];
    s.internal_work += forces.internal[i] * u[i];
    s.residual += residual * residual;
    s.reaction += reaction * reaction;
    s.contact += contact[i] * contact[i];
    s.load += load * load;
    s.moved += u[i] * u[i];
    s.stiff += stiff * stiff;
    s.moved_all += std::abs(u[i]);
    s.stiff_all += std::abs(stiff);
    s.stiff_work += stiff * u[i];
    s.softness += 1.0 / diagonal;
  }
  // Springs are supports as the balance sees them; those of a node are one.
  for (auto spring = part.springs.begin(); spring != part.springs.end();) {
    const std::int32_t node = spring->node;
    if (node >= part.owned_nodes()) break;
    Vector3 force{};
    for (; spring != part.springs.end() && spring->node == node; ++spring)
      force = force + spring_force(*spring, part, u);
    for (std::size_t c = 0; c < dim; ++c) {
      s.balance[c] += force[c];
      s.all += std::abs(force[c]);
      s.reaction += force[c] * force[c];
    }
  }
  part.node_map.sum_each({&s.balance[0], &s.balance[1], &s.balance[2], &s.all, &s.residual_work,
                          &s.internal_work, &s.residual, &s.reaction, &s.contact, &s.load, &s.moved, &s.stiff,
                          &s.stiff_work, &s.moved_all, &s.stiff_all, &s.softness});
  s.softness /= static_cast<double>(part.total_nodes()) * part.dim();
  return s;
}

}  // namespace

Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        const BodyForces& forces) {
  const Part& part = space.part();
  Vector contact(part.unknowns(), 0.0);
  traces.add_force(state.lambda, 1.0, contact);
  Residuals out;
  out.energy = forces.energy;
  Scales& scales = out.scales;
  scales.displacement = space.max_abs(state.u);
  const ContactSums sums = contact_sums(traces, state, scales.displacement);
  // Sums of forces: the load, the obstacles, the supports; what they work; squares of their norms.
  const BodySums body = body_sums(part, state.u, contact, forces);
  const double no_force = least_force / body.softness * std::sqrt(body.moved),
               no_energy = least_force / body.softness * body.moved;
  scales.force = std::max(std::sqrt(std::max({body.reaction, body.contact, body.load})), no_force);

  const double tiny = 1e-300;
  scales.pressure = std::max(sums.pressure, sums.area > 0.0 ? 0.5 * body.all / sums.area * 1e-3 : 0.0);
  const double force = std::max(scales.force, tiny), displacement = std::max(scales.displacement, tiny);
  const double pressure = std::max(scales.pressure, tiny);
  Certificate& c = out.certificate;
  const double unknown_force = rounding * std::sqrt(body.stiff), unknown_energy = rounding * body.stiff_work;
  const double moved = scales.displacement > 0.0 ? 1.0 : 0.0;  // at rest, traces and gaps are exact
  c.equilibrium = std::sqrt(body.residual) / force;
  c.rounding.equilibrium = unknown_force / force;
  c.penetration = sums.penetration / displacement;
  c.rounding.penetration = moved * sums.unknown_trace / displacement;
  c.tension = sums.tension / pressure;
  c.friction_cone = sums.cone / pressure;
  const double most_product = std::max(pressure * displacement * sums.area, tiny);
  c.complementarity = (sums.normal_product + sums.friction_product) / most_product;
  c.rounding.complementarity = moved * sums.unknown_product / most_product;
  const double all_forces = std::max({body.all, least_force / body.softness * body.moved_all, tiny});
  const bool is_round =
      part.plane == PlaneState::axisymmetric;  // round an axis the first is in balance by itself
  c.force_balance =
      std::hypot(is_round ? 0.0 : body.balance[0], body.balance[1], body.balance[2]) / all_forces;
  // Equal elements that move alike are off alike: nothing averages out in a sum.
  c.rounding.force_balance = rounding * body.stiff_all / all_forces;
  // Primal minus dual energy. With τ = τ(u) the stored energies add up to R·u, and
  // what is left is the work of the equilibrium residual and the contact products.
  const double all_energy = std::max({forces.energy, 0.5 * std::abs(body.internal_work), no_energy, tiny});
  c.duality_gap = std::abs(sums.dual_work - body.residual_work) / all_energy;
  c.rounding.duality_gap = (unknown_energy + moved * sums.unknown_product) / all_energy;
  return out;
}

}  // namespace kacanov
