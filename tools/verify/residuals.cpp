// SPDX-License-Identifier: BSD-3-Clause
// The entries of the certificate (theory: kkt, duality-gap, rounding), and the forces, of an answer.
#include "verify/residuals.hpp"

#include "verify/body.hpp"

namespace kacanov::verify {
namespace {

constexpr Real tiny = 1e-300L, least_force = 3e-9L, delta = 1e-15L, delta_of_traces = 3e-16L;

/// Slip: u, less what it is counted from, in the directions that are free and orthogonal to the row's
/// normal.
Vec tangential(const Problem& problem, const ContactRow& row, const std::vector<Vec>& u) {
  Vec sum{};
  for (const ContactRow::Share& share : row.shares) {
    const auto node = static_cast<std::size_t>(share.node);
    const Vec free = free_part(problem, share.node, u[node] - row.slip_origin);
    const Vec along = 1 / norm(share.normal) * share.normal;
    // The weight of a node in a row of several is the length of its normal among theirs.
    const Real weight = row.shares.size() == 1 ? Real(1) : norm(share.normal);
    sum = sum + weight * (free - dot(free, along) * along);
  }
  return sum;
}

struct ContactSums {
  Real products = 0, work = 0, area = 0, pressure = 0, unknown_trace = 0, unknown_product = 0;
  Real penetration = 0, tension = 0, cone = 0;
  std::vector<Vec> force;  ///< CᵀMλ, one a node
};

ContactSums sum_contact(const Problem& problem, const Answer& answer, Findings& findings) {
  ContactSums sums;
  Real most = 0;
  for (const Vec& u : answer.u)
    for (const Real component : u) most = larger(most, std::abs(component));
  for (const Vec& u : problem.point.before)
    for (const Real component : u) most = larger(most, std::abs(component));
  sums.force.assign(problem.mesh.nodes.size(), {});
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const ContactRow& row = problem.rows[i];
    const Real lambda = answer.pressure[i];
    const Vec& traction = answer.traction[i];
    Real trace = 0;
    for (const ContactRow::Share& share : row.shares) {
      trace += dot(share.normal, answer.u[share.node]);
      Vec& force = sums.force[share.node];
      const Real weight = row.shares.size() == 1 ? Real(1) : norm(share.normal);
      force = force + row.mass * (lambda * share.normal - weight * traction);
      findings.contact_force = findings.contact_force - row.mass * lambda * share.normal;
    }
    findings.friction_force = findings.friction_force + row.mass * traction;
    findings.force += row.mass * (std::abs(lambda) + norm(traction));
    findings.pressure = larger(findings.pressure, lambda);
    const Real open = row.gap - trace;
    sums.products += row.mass * std::abs(lambda * open);
    sums.work += row.mass * lambda * open;
    sums.area += row.mass;
    sums.penetration = larger(sums.penetration, -open);
    sums.tension = larger(sums.tension, -lambda);
    sums.pressure = larger(sums.pressure, std::abs(lambda));
    const Real unknown = delta_of_traces * (most + std::abs(row.gap)) + row.unknown_gap;
    if (open <= unknown) sums.unknown_trace = larger(sums.unknown_trace, unknown);
    sums.unknown_product += row.mass * std::abs(lambda) * unknown;
    if (!row.friction) continue;
    const Vec slip = tangential(problem, row, answer.u);
    const Real bound = row.tresca + row.coulomb * lambda, length = norm(traction);
    const Real product = bound * norm(slip) + dot(traction, slip);
    sums.products += row.mass * std::abs(product);
    sums.unknown_product += row.mass * (bound + length) * delta_of_traces * (most + norm(slip));
    sums.work += row.mass * product;
    sums.cone = larger(sums.cone, length - bound);
    sums.pressure = larger(sums.pressure, length);
  }
  return sums;
}

struct BodySums {
  Vec balance{};
  Real all = 0, residual_work = 0, internal_work = 0, residual = 0, reaction = 0, contact = 0, load = 0;
  Real moved = 0, stiff = 0, stiff_work = 0, moved_all = 0, stiff_all = 0, softness = 0, displacement = 0,
       supports = 0;
};

BodySums sum_body(const Problem& problem, const Answer& answer, const BodyResponse& body,
                  const std::vector<Vec>& contact) {
  BodySums s;
  const auto dim = static_cast<std::size_t>(problem.mesh.dim());
  for (std::size_t n = 0; n < problem.mesh.nodes.size(); ++n) {
    const Vec all = problem.load[n] - body.internal[n] - contact[n];
    const Vec left = free_part(problem, static_cast<Index>(n), all);
    for (std::size_t c = 0; c < dim; ++c) {
      const Real u = answer.u[n][c], load = problem.load[n][c], d = body.diagonal[n][c];
      const Real reaction = left[c] - all[c], residual = left[c];
      s.balance[c] += load - contact[n][c] + reaction;
      s.all += std::abs(load) + std::abs(contact[n][c]) + std::abs(reaction);
      s.residual_work += residual * u;
      s.internal_work += body.internal[n][c] * u;
      s.residual += residual * residual;
      s.reaction += reaction * reaction;
      s.contact += contact[n][c] * contact[n][c];
      s.load += load * load;
      s.moved += u * u;
      s.stiff += d * u * d * u;
      s.stiff_work += d * u * u;
      s.moved_all += std::abs(u);
      s.stiff_all += std::abs(d * u);
      s.softness += 1 / d;
      s.displacement = larger(s.displacement, std::abs(u));
      if (problem.held[n][c]) s.supports = larger(s.supports, std::abs(u - problem.prescribed[n][c]));
    }
  }
  for (const auto& [node, given] : problem.directions)
    for (const GivenDirection& one : given)
      s.supports = larger(s.supports, std::abs(dot(one.direction, answer.u[node]) - one.value));
  // What holds a spring at its other end.
  for (std::size_t n = 0; n < problem.springs.size(); ++n)
    for (std::size_t c = 0; c < dim; ++c) {
      const Real force = -dot(problem.springs[n][c], answer.u[n]);
      s.balance[c] += force;
      s.all += std::abs(force);
      s.reaction += force * force;
    }
  s.softness /= static_cast<Real>(problem.mesh.nodes.size() * dim);
  return s;
}

}  // namespace

Findings examine(const Problem& problem, const Answer& answer) {
  Findings findings;
  const BodyResponse response = respond(problem, answer.u);
  const ContactSums sums = sum_contact(problem, answer, findings);
  const BodySums body = sum_body(problem, answer, response, sums.force);
  findings.von_mises = response.most_von_mises;
  findings.unknown_stress = response.unknown_stress;

  const Real soft = least_force / body.softness;
  const Real no_force = soft * std::sqrt(body.moved), no_energy = soft * body.moved;
  const Real force =
      larger(larger(std::sqrt(larger(body.reaction, larger(body.contact, body.load))), no_force), tiny);
  const Real moved = larger(body.displacement, tiny),
             all = larger(larger(body.all, soft * body.moved_all), tiny);
  const Real pressure =
      larger(larger(sums.pressure, sums.area > 0 ? body.all / 2 / sums.area * 1e-3L : Real(0)), tiny);
  const Real product = larger(pressure * moved * sums.area, tiny);
  const Real energy =
      larger(larger(response.energy, std::abs(body.internal_work) / 2), larger(no_energy, tiny));
  const Real unknown_force = delta * std::sqrt(body.stiff);
  const Real at_all = body.displacement > 0 ? 1 : 0;
  findings.supports = body.supports / moved;
  Vec balance = body.balance;
  if (problem.mesh.is_round) balance[0] = 0;  // away from an axis all is in balance by itself
  findings.entries = {{"equilibrium", std::sqrt(body.residual) / force, unknown_force / force},
                      {"penetration", sums.penetration / moved, at_all * sums.unknown_trace / moved},
                      {"tension", sums.tension / pressure, 0},
                      {"complementarity", sums.products / product, at_all * sums.unknown_product / product},
                      {"friction_cone", sums.cone / pressure, 0},
                      {"force_balance", norm(balance) / all, delta * body.stiff_all / all},
                      {"duality_gap", std::abs(sums.work - body.residual_work) / energy,
                       (delta * body.stiff_work + at_all * sums.unknown_product) / energy}};
  return findings;
}

}  // namespace kacanov::verify
