// SPDX-License-Identifier: BSD-3-Clause
// Recomputes the certificate (theory: kkt, duality-gap, rounding) and the contact forces of a solution.
#include "verify/residuals.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace kacanov::verify {
namespace {

constexpr Real tiny = 1e-300L, least_force = 3e-9L, least_share = 1e-3L, expansion_noise = 1e-13L,
               least_displacement = 1e-8L, delta = 1e-15L, delta_of_traces = 3e-16L;

/// Returns the slip: u minus its origin, in the free directions orthogonal to the row's normal.
Vec tangential(const Problem& problem, const ContactRow& row, const std::vector<Vec>& u) {
  Vec sum{};
  for (const ContactRow::Share& share : row.shares) {
    const auto node = static_cast<std::size_t>(share.node);
    const Vec free = free_part(problem, share.node, u[node] - row.slip_origin);
    const Vec along = 1 / norm(share.normal) * share.normal;
    // In a row of several nodes, the weight of a node is the length of its normal.
    const Real weight = row.shares.size() == 1 ? Real(1) : norm(share.normal);
    sum = sum + weight * (free - dot(free, along) * along);
  }
  return sum;
}

/// Reference for a quantity that is weak beside others: the geometric mean of both, at least a share of the
/// strong one.
Real weak_beside(Real weak, Real strong, Real least) {
  return std::min(strong, larger(std::sqrt(weak * strong), least * strong));
}

/// Sums and extremes over the rows of one contact entry in one region.
struct Group {
  Real products = 0, area = 0, square = 0, pressure = 0, indentation = 0;
  Real unknown_trace = 0, unknown_product = 0, penetration = 0, tension = 0, cone = 0;
};

struct Contact {
  std::map<std::pair<std::size_t, std::size_t>, Group> groups;  ///< by region, then entry
  Real work = 0, unknown_product = 0;
  std::vector<Vec> force;  ///< CᵀMλ, one per node
};

/// Returns the mean of D over the nodes of a row.
Real stiffness_of(const Problem& problem, const BodyResponse& body, const ContactRow& row) {
  const auto dim = static_cast<std::size_t>(problem.mesh.dim());
  Real sum = 0;
  for (const ContactRow::Share& share : row.shares)
    for (std::size_t c = 0; c < dim; ++c) sum += body.diagonal[share.node][c];
  return sum / static_cast<Real>(dim * row.shares.size());
}

Contact sum_contact(const Problem& problem, const Regions& regions, const BodyResponse& body,
                    const Answer& answer, Findings& findings) {
  Contact out;
  Real most = 0;
  for (const Vec& u : answer.u)
    for (const Real component : u) most = larger(most, std::abs(component));
  out.force.assign(problem.mesh.nodes.size(), {});
  for (const Vec& u : problem.point.before)
    for (const Real component : u) most = larger(most, std::abs(component));
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const ContactRow& row = problem.rows[i];
    Group& group = out.groups[{regions.of_node[row.shares[0].node], row.entry}];
    const Real lambda = answer.pressure[i];
    const Vec& traction = answer.traction[i];
    Real trace = 0;
    for (const ContactRow::Share& share : row.shares) {
      trace += dot(share.normal, answer.u[share.node]);
      Vec& force = out.force[share.node];
      const Real weight = row.shares.size() == 1 ? Real(1) : norm(share.normal);
      force = force + row.mass * (lambda * share.normal - weight * traction);
      findings.contact_force = findings.contact_force - row.mass * lambda * share.normal;
    }
    findings.friction_force = findings.friction_force + row.mass * traction;
    findings.force += row.mass * (std::abs(lambda) + norm(traction));
    findings.pressure = larger(findings.pressure, lambda);
    const Real open = row.gap - trace, length = norm(traction);
    group.products += row.mass * std::abs(lambda * open);
    out.work += row.mass * lambda * open;
    group.area += row.mass;
    group.square += row.mass * row.mass * (lambda * lambda + length * length);
    group.penetration = larger(group.penetration, -open);
    group.tension = larger(group.tension, -lambda);
    group.pressure = larger(group.pressure, std::abs(lambda));
    group.indentation =
        larger(group.indentation, row.mass * std::abs(lambda) / stiffness_of(problem, body, row));
    const Real unknown = delta_of_traces * (most + std::abs(row.gap)) + row.unknown_gap;
    if (open <= unknown) group.unknown_trace = larger(group.unknown_trace, unknown);
    Real unknown_product = row.mass * std::abs(lambda) * unknown;
    if (row.friction) {
      const Vec slip = tangential(problem, row, answer.u);
      const Real bound = row.tresca + row.coulomb * lambda;
      const Real product = bound * norm(slip) + dot(traction, slip);
      group.products += row.mass * std::abs(product);
      unknown_product += row.mass * (bound + length) * delta_of_traces * (most + norm(slip));
      out.work += row.mass * product;
      group.cone = larger(group.cone, length - bound);
      group.pressure = larger(group.pressure, length);
    }
    group.unknown_product += unknown_product;
    out.unknown_product += unknown_product;
  }
  return out;
}

/// Sums over the nodes of one region.
struct RegionSums {
  Vec unbalanced{}, moment{};
  Real residual = 0, load = 0, reaction = 0, spring = 0, interface = 0, hold = 0, all = 0;
  Real moved = 0, stiff = 0, moved_all = 0, stiff_all = 0, softness = 0, unknowns = 0, largest = 0,
       expansion = 0, expansion_all = 0;
};

struct BodySums {
  std::vector<RegionSums> of_region;
  std::map<std::pair<std::size_t, std::size_t>, Real> between;  ///< forces of softer regions on stiffer ones
  Real residual_work = 0, internal_work = 0, expansion_work = 0, stiff_work = 0;
  Real displacement = 0, supports = 0;
  Real least_expansion = 0;  ///< lower limit of force scales, relative to the nodal forces of temperature
};

BodySums sum_body(const Problem& problem, const Regions& regions, const Answer& answer,
                  const BodyResponse& body, const std::vector<Vec>& contact) {
  BodySums sums;
  sums.of_region.resize(regions.bin.size());
  sums.least_expansion = std::min(1e-3L, expansion_noise / problem.tolerance);
  const auto dim = static_cast<std::size_t>(problem.mesh.dim());
  for (std::size_t n = 0; n < problem.mesh.nodes.size(); ++n) {
    const std::size_t region = regions.of_node[n];
    RegionSums& s = sums.of_region[region];
    const Vec all = problem.load[n] - body.internal[n] - contact[n];
    const Vec left = free_part(problem, static_cast<Index>(n), all);
    for (std::size_t c = 0; c < dim; ++c) {
      const Real u = answer.u[n][c], load = problem.load[n][c] - body.expansion[n][c],
                 d = body.diagonal[n][c];
      const Real spring = problem.springs.empty() ? Real(0) : -dot(problem.springs[n][c], answer.u[n]);
      const Real reaction = left[c] - all[c], residual = left[c];
      s.unbalanced[c] += residual;
      s.residual += residual * residual;
      s.load += problem.held[n][c] ? Real(0) : load * load;
      s.expansion += body.expansion[n][c] * body.expansion[n][c];
      s.expansion_all += std::abs(body.expansion[n][c]);
      s.reaction += reaction * reaction;
      s.spring += spring * spring;
      const Real hold = std::abs(contact[n][c]) + std::abs(reaction) + std::abs(spring);
      s.hold += hold;
      s.all += hold + std::abs(load);
      s.moved += u * u;
      s.stiff += d * u * d * u;
      s.moved_all += std::abs(u);
      s.stiff_all += std::abs(d * u);
      s.softness += 1 / d;
      s.unknowns += 1;
      s.largest = larger(s.largest, std::abs(u));
      sums.residual_work += residual * u;
      sums.internal_work += body.internal[n][c] * u;
      sums.expansion_work += body.expansion[n][c] * u;
      sums.stiff_work += d * u * u;
      sums.displacement = larger(sums.displacement, std::abs(u));
    }
    Vec place = problem.mesh.nodes[n], residual = left;
    for (std::size_t c = dim; c < 3; ++c) place[c] = residual[c] = 0;
    s.moment = s.moment + cross(place, residual);
    for (const RegionForce& other : body.of_region[n]) {
      if (body.of_region[n].size() == 1) break;
      for (std::size_t c = 0; c < dim; ++c) {
        sums.of_region[other.region].interface += other.force[c] * other.force[c];
        if (other.region == region) continue;
        sums.between[{region, other.region}] += std::abs(other.force[c]);
        const Real stiff = other.diagonal[c] * other.largest;
        s.stiff += stiff * stiff;
        s.stiff_all += stiff;
      }
    }
  }
  for (const auto& [node, supports] : problem.supports)
    sums.supports = larger(sums.supports, off_supports(supports, answer.u[node], sums.displacement));
  return sums;
}

/// The entry with the largest sum of residual and possible round-off.
struct Worst {
  Real residual = 0, rounding = 0;
  void take(Real r, Real unknown, Real scale) {
    scale = larger(scale, tiny);
    if (!(residual + rounding > (r + unknown) / scale)) residual = r / scale, rounding = unknown / scale;
  }
};

Real least_stiffness(const RegionSums& s) {
  return s.softness > 0 ? least_force * s.unknowns / s.softness : 0;
}

Worst judge_equilibrium(const Contact& contact, const BodySums& body, Real elastic, Real& idle) {
  Worst worst;
  std::vector<Real> scale;
  idle = 0;
  for (std::size_t r = 0; r < body.of_region.size(); ++r) {
    const RegionSums& s = body.of_region[r];
    Real weakest = HUGE_VALL, square = 0;
    for (const auto& [place, group] : contact.groups)
      if (place.first == r && group.square > 0) {
        weakest = std::min(weakest, std::sqrt(group.square));
        square += group.square;
      }
    const Real own = body.of_region.size() == 1 ? 2 * elastic * s.unknowns / s.softness : Real(0);
    const Real outer = larger(larger(s.load, s.reaction), larger(s.spring, square));
    Real force = std::sqrt(larger(outer, larger(s.interface, own)));
    if (weakest < HUGE_VALL) force = weak_beside(weakest, force, least_share);
    force = larger(force, larger(least_stiffness(s) * std::sqrt(s.moved),
                                 body.least_expansion * std::sqrt(s.expansion)));
    if (s.softness > 0) idle = larger(idle, least_displacement * force * s.softness / s.unknowns);
    scale.push_back(force);
  }
  for (std::size_t r = 0; r < scale.size(); ++r) {
    const RegionSums& s = body.of_region[r];
    if (s.unknowns > 0)
      worst.take(std::sqrt(s.residual), delta * std::sqrt(s.stiff),
                 larger(scale[r], idle * s.unknowns / s.softness));
  }
  return worst;
}

Worst judge_balance(const Problem& problem, const Regions& regions, const BodySums& body, Real idle) {
  Worst worst;
  for (const Regions::Cluster& cluster : regions.clusters) {
    RegionSums s;
    for (std::size_t r = 0; r < cluster.has.size(); ++r) {
      if (!cluster.has[r]) continue;
      const RegionSums& one = body.of_region[r];
      s.unbalanced = s.unbalanced + one.unbalanced;
      s.moment = s.moment + one.moment;
      s.hold += one.hold, s.all += one.all;
      s.moved_all += one.moved_all, s.stiff_all += one.stiff_all;
      s.softness += one.softness, s.unknowns += one.unknowns;
      s.expansion_all += one.expansion_all;
    }
    for (const auto& [pair, force] : body.between)
      if (cluster.has[pair.first] && regions.bin[pair.second] > cluster.bin) s.hold += force, s.all += force;
    Real scale = larger(weak_beside(s.hold, s.all, least_share),
                        larger(least_stiffness(s) * s.moved_all, body.least_expansion * s.expansion_all));
    scale = larger(scale, idle * std::sqrt(s.unknowns) * s.unknowns / s.softness);
    Vec moment = s.moment - cross(cluster.centre, s.unbalanced);
    // In axisymmetry the radial force and the moment balance by themselves.
    if (problem.mesh.is_round) s.unbalanced[0] = 0, moment = {};
    worst.take(norm(s.unbalanced), delta * s.stiff_all, scale);
    worst.take(norm(moment), delta * s.stiff_all * cluster.radius, scale * cluster.radius);
  }
  return worst;
}

}  // namespace

Findings examine(const Problem& problem, const Answer& answer) {
  Findings findings;
  const Regions regions = find_regions(problem);
  const BodyResponse response = respond(problem, regions, answer.u);
  const Contact contact = sum_contact(problem, regions, response, answer, findings);
  const BodySums body = sum_body(problem, regions, answer, response, contact.force);
  findings.von_mises = response.most_von_mises;
  findings.unknown_stress = response.unknown_stress;
  findings.supports = body.supports / larger(body.displacement, tiny);
  findings.body = response;

  Worst penetration, tension, complementarity, cone;
  for (const auto& [place, group] : contact.groups) {
    if (!(group.area > 0)) continue;
    const RegionSums& region = body.of_region[place.first];
    const Real pressure = larger(larger(group.pressure, least_share * region.all / 2 / group.area), tiny);
    const Real length = larger(weak_beside(group.indentation, region.largest, least_share), tiny);
    const Real moved = region.largest > 0 ? 1 : 0;
    penetration.take(group.penetration, moved * group.unknown_trace, length);
    tension.take(group.tension, 0, pressure);
    cone.take(group.cone, 0, pressure);
    complementarity.take(group.products, moved * group.unknown_product, pressure * length * group.area);
  }
  RegionSums whole;
  for (const RegionSums& s : body.of_region) {
    whole.moved += s.moved, whole.softness += s.softness, whole.unknowns += s.unknowns;
  }
  const Real all_energy = larger(response.energy, std::abs(body.internal_work) / 2);
  const bool warm = response.expansion_energy > 0;
  const Real elastic =
      warm ? larger(response.energy - body.expansion_work + response.expansion_energy, 0) : all_energy;
  const Real energy = larger(weak_beside(elastic, all_energy, least_share),
                             larger(least_stiffness(whole) * whole.moved, tiny));
  const Real moved = body.displacement > 0 ? 1 : 0;
  Real idle = 0;
  const Worst equilibrium = judge_equilibrium(contact, body, warm ? elastic : Real(0), idle),
              balance = judge_balance(problem, regions, body, idle);
  findings.entries = {{"equilibrium", equilibrium.residual, equilibrium.rounding},
                      {"penetration", penetration.residual, penetration.rounding},
                      {"tension", tension.residual, 0},
                      {"complementarity", complementarity.residual, complementarity.rounding},
                      {"friction_cone", cone.residual, 0},
                      {"force_balance", balance.residual, balance.rounding},
                      {"duality_gap", std::abs(contact.work - body.residual_work) / energy,
                       (delta * body.stiff_work + moved * contact.unknown_product) / energy}};
  return findings;
}

}  // namespace kacanov::verify
