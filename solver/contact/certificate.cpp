// SPDX-License-Identifier: BSD-3-Clause
// KKT residuals of a state, relative to scales computed from that state.
#include "contact/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "linear/springs.hpp"
#include "parallel/exchange.hpp"
#include "problem/vector3.hpp"

namespace kacanov {

namespace {

/// The larger of the two; infinity if one is NaN, which std::max may drop.
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

/// Smaller forces, relative to the harmonic mean of D times ‖u‖, do not serve as scale. The harmonic mean,
/// because a nearly rigid part would otherwise make any force look small.
constexpr double least_force = 3e-9;
/// The scale of a quantity that is weak relative to others is the geometric mean of both, but at least this
/// share of the strong one (theory: kkt).
constexpr double least_share = 1e-3;
/// Residuals below this share of the nodal forces of temperature are noise: these forces balance each other
/// in a freely expanding body, up to a hundred rounding errors. The lower limit of the scale follows from it.
constexpr double expansion_noise = 1e-13, largest_expansion_share = 1e-3;
/// Lower limit of a region's force scale, where nothing acts on it: its stiffness times this share of the
/// largest ratio force / stiffness, a displacement, over all regions.
constexpr double least_displacement = 1e-8;
/// Rounding error of R(u) relative to D∘u, and of its work relative to u·(D∘u): nine units of rounding,
/// because a row of B is a few times its diagonal (measured: up to 5.4e-16); and of traces and gaps, which
/// are short sums.
constexpr double rounding = 1e-15, rounding_of_traces = 3e-16;
constexpr double tiny = 1e-300;

double least_expansion(double tolerance) {
  return std::min(largest_expansion_share, expansion_noise / tolerance);
}

double weak_beside(double weak, double strong, double least = least_share) {
  return std::min(strong, std::max(std::sqrt(weak * strong), least * strong));
}

/// The structs as numbers, for one joint reduction.
template <class Struct>
std::span<double> numbers(std::vector<Struct>& structs) {
  return {reinterpret_cast<double*>(structs.data()), structs.size() * sizeof(Struct) / sizeof(double)};
}

/// Sums over the points of one contact entry in one region.
struct ContactSums {
  double products = 0.0;  // Σ M |λ_n (Nu − ρ)| + Σ M | ψ|Tu| − λ_t·Tu |
  double dual_work = 0.0;  // Σ M (λ_n (ρ − Nu) + ψ|Tu| − λ_t·Tu), the contact part of the duality gap
  double area = 0.0, square = 0.0;  // Σ M, Σ (M |λ|)²
  double unknown_product = 0.0;     // rounding error of Σ M λ times a gap
};

/// Maxima over the points of one contact entry in one region.
struct ContactPeaks {
  double penetration = 0.0, tension = 0.0, cone = 0.0, pressure = 0.0;
  double indentation = 0.0;    // M λ_n over the stiffness of the nodes
  double unknown_trace = 0.0;  // rounding error of a gap
};

/// Sums and maxima of contact, by region and entry.
struct Contact {
  std::size_t entries = 0;
  std::vector<ContactSums> sums;
  std::vector<ContactPeaks> peaks;
};

/// Returns the mean of D at the nodes of a point.
double stiffness_of(std::span<const RowEntry> entries, std::span<const float> diagonal, std::size_t dim) {
  double sum = 0.0;
  for (const RowEntry& entry : entries)
    for (std::size_t c = 0; c < dim; ++c) sum += static_cast<double>(diagonal[entry.node * dim + c]);
  return sum / static_cast<double>(entries.size() * dim);
}

/// `displacement`: max |u|. The rounding error of a trace is that of the displacements it is computed from,
/// however small the trace is.
Contact sum_contact(const Traces& traces, const ContactState& state, const BodyForces& forces,
                    const StiffnessRegions& regions, double displacement) {
  const auto points = traces.points().first(traces.owned());
  const std::size_t dim = traces.part().dim();
  std::int32_t entries = 0;
  for (const ContactPoint& point : points) entries = std::max(entries, point.entry + 1);
  Contact out;
  out.entries = static_cast<std::size_t>(traces.ranks().max_all(entries));
  out.sums.resize(out.entries * regions.count());
  out.peaks.resize(out.sums.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    const auto rows = traces.entries(i);
    const std::size_t group = static_cast<std::size_t>(regions.of_node(rows[0].node)) * out.entries +
                              static_cast<std::size_t>(point.entry);
    ContactSums& s = out.sums[group];
    ContactPeaks& peak = out.peaks[group];
    const double lambda = state.lambda.normal[i], open = state.gap[i] - state.trace.normal[i];
    const double* slip = &state.trace.tangential[2 * i];
    const double* friction = &state.lambda.tangential[2 * i];
    s.products += point.mass * std::abs(lambda * open);
    s.dual_work += point.mass * lambda * open;
    s.area += point.mass;
    const double pressure = std::hypot(lambda, friction[0], friction[1]);
    s.square += point.mass * pressure * point.mass * pressure;
    peak.penetration = larger(peak.penetration, -open);
    peak.tension = larger(peak.tension, -lambda);
    peak.pressure = larger(peak.pressure, std::abs(lambda));
    peak.indentation =
        larger(peak.indentation, point.mass * std::abs(lambda) / stiffness_of(rows, forces.diagonal, dim));
    // A gap larger than its rounding error is open and does not count as a rounding error of penetration.
    const double unknown = rounding_of_traces * (displacement + std::abs(state.gap[i])) + point.unknown_gap;
    if (open <= unknown) peak.unknown_trace = larger(peak.unknown_trace, unknown);
    s.unknown_product += point.mass * std::abs(lambda) * unknown;
    if (point.tangents == 0) continue;
    const double bound = state.bound[i], length = std::hypot(friction[0], friction[1]);
    const double slid = std::hypot(slip[0], slip[1]);
    const double product = bound * slid - friction[0] * slip[0] - friction[1] * slip[1];
    s.products += point.mass * std::abs(product);
    s.unknown_product += point.mass * (bound + length) * rounding_of_traces * (displacement + slid);
    s.dual_work += point.mass * product;
    peak.cone = larger(peak.cone, length - bound);
    peak.pressure = larger(peak.pressure, length);
  }
  traces.ranks().sum_all(numbers(out.sums));
  traces.ranks().max_all(numbers(out.peaks));
  return out;
}

/// Sums over the unknowns of one region.
struct RegionSums {
  Vector3 unbalanced{}, moment{};  // of the residual, about the origin
  double residual = 0.0;           // squares of norms: of the residual, and of the forces
  double load = 0.0, reaction = 0.0, spring = 0.0, interface = 0.0;  // of the load without temperature
  double hold = 0.0;                                                 // Σ |force| of supports and obstacles
  double all = 0.0;                                                  // the same including loads
  double moved = 0.0, stiff = 0.0;                                   // |u|², |D∘u|²
  double moved_all = 0.0, stiff_all = 0.0;                           // Σ |u|, Σ |D∘u|
  double softness = 0.0, unknowns = 0.0;                             // Σ 1/D
  double expansion = 0.0, expansion_all = 0.0;                       // |F_T|², Σ |F_T|
};

/// Sums over the unknowns of the body.
struct WholeSums {
  double residual_work = 0.0, internal_work = 0.0, stiff_work = 0.0, moved = 0.0, softness = 0.0;
  double expansion_work = 0.0;
};

struct BodySums {
  std::vector<RegionSums> of_region;
  std::vector<double> largest;  ///< max |u| of each region
  WholeSums whole;
  double least_expansion = 0.0;  ///< lower limit of force scales, relative to the nodal forces of temperature
  /// Σ |force| of a region's stresses on nodes of a stiffer one.
  std::map<std::array<std::int32_t, 2>, double> between;  ///< [stiffer, softer]
};

/// Returns the reactions of supports along prescribed directions, one value per unknown: minus the component
/// of F − R − CᵀMλ along them. Empty if there are none.
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

/// Spring forces on the nodes of a part, in node order.
class SpringForces {
 public:
  SpringForces(const Part& part, std::span<const double> u)
      : part_(part), u_(u), next_(part.springs.begin()) {}
  /// Returns the force on a node; calls must be in ascending node order.
  Vector3 at(std::int32_t node) {
    Vector3 force{};
    for (; next_ != part_.springs.end() && next_->node == node; ++next_)
      force = force + spring_force(*next_, part_, u_);
    return force;
  }

 private:
  const Part& part_;
  std::span<const double> u_;
  std::vector<NodeSpring>::const_iterator next_;
};

/// Computes the sums over all ranks; `contact` is CᵀMλ.
BodySums body_sums(const Part& part, const Vector& u, std::span<const double> contact,
                   const BodyForces& forces, const StiffnessRegions& regions) {
  const std::size_t dim = part.dim();
  BodySums out;
  out.least_expansion = least_expansion(forces.tolerance);
  out.of_region.resize(regions.count());
  out.largest.resize(regions.count());
  const Vector slanting = slanting_reactions(part, contact, forces);
  SpringForces springs(part, u);
  auto loaded = forces.load.begin();
  auto side = forces.interface.begin();
  std::map<std::array<std::int32_t, 2>, double>& between = out.between;
  for (std::int32_t n = 0; n < part.owned_nodes(); ++n) {
    const std::int32_t region = regions.of_node(n);
    RegionSums& s = out.of_region[region];
    const Vector3 spring = springs.at(n);
    Vector3 residual{}, position{};
    for (std::size_t c = 0; c < dim; ++c) {
      const std::size_t i = static_cast<std::size_t>(n) * dim + c;
      const bool here = loaded != forces.load.end() && static_cast<std::size_t>(loaded->component) == i;
      const double load = here ? (loaded++)->value : 0.0, diagonal = static_cast<double>(forces.diagonal[i]);
      const double unbalanced = load - forces.internal[i] - contact[i], stiff = diagonal * u[i];
      const double along = slanting.empty() ? 0.0 : slanting[i];
      const double reaction = part.held[i] ? -unbalanced : along;
      residual[c] = part.held[i] ? 0.0 : unbalanced + along;
      position[c] = part.coordinates[i];
      const double expansion = forces.expansion.empty() ? 0.0 : forces.expansion[i];
      const double acting = part.held[i] ? 0.0 : load - expansion;
      s.load += acting * acting;
      s.expansion += expansion * expansion;
      s.expansion_all += std::abs(expansion);
      s.reaction += reaction * reaction;
      s.spring += spring[c] * spring[c];
      s.residual += residual[c] * residual[c];
      const double hold = std::abs(contact[i]) + std::abs(reaction) + std::abs(spring[c]);
      s.hold += hold;
      s.all += hold + std::abs(load - expansion);
      s.moved += u[i] * u[i];
      s.stiff += stiff * stiff;
      s.moved_all += std::abs(u[i]);
      s.stiff_all += std::abs(stiff);
      s.softness += 1.0 / diagonal;
      s.unknowns += 1.0;
      out.largest[region] = larger(out.largest[region], std::abs(u[i]));
      out.whole.residual_work += residual[c] * u[i];
      out.whole.internal_work += forces.internal[i] * u[i];
      out.whole.expansion_work += expansion * u[i];
      out.whole.stiff_work += stiff * u[i];
    }
    s.unbalanced = s.unbalanced + residual;
    s.moment = s.moment + cross(position, residual);
    for (; side != forces.interface.end() && side->node == n; ++side) {
      out.of_region[side->region].interface += dot(side->force, side->force);
      if (side->region == region) continue;
      for (std::size_t c = 0; c < dim; ++c) {
        between[{region, side->region}] += std::abs(side->force[c]);
        s.stiff += side->stiff[c] * side->stiff[c];
        s.stiff_all += side->stiff[c];
      }
    }
  }
  const IndexMap& ranks = part.node_map;
  ranks.sum_all(numbers(out.of_region));
  ranks.max_all(out.largest);
  for (const RegionSums& s : out.of_region) {
    out.whole.moved += s.moved;
    out.whole.softness += s.softness;
  }
  WholeSums& w = out.whole;
  ranks.sum_each({&w.residual_work, &w.internal_work, &w.expansion_work, &w.stiff_work});
  w.softness /= static_cast<double>(part.total_nodes()) * part.dim();
  if (regions.count() > 1) {
    struct Pair {
      std::array<std::int32_t, 2> regions;
      double force;
    };
    std::vector<Pair> pairs;
    for (const auto& [pair, force] : between) pairs.push_back({pair, force});
    between.clear();
    for (const Pair& pair : gathered(pairs, ranks)) between[pair.regions] += pair.force;
  }
  return out;
}

/// The worst residual, counted with its rounding error.
struct Worst {
  double residual = 0.0, unknown = 0.0;
  void take(double r, double rounding_of_it, double scale) {
    r /= scale, rounding_of_it /= scale;
    if (std::isnan(r + rounding_of_it)) r = HUGE_VAL;
    if (residual + unknown <= r + rounding_of_it) residual = r, unknown = rounding_of_it;
  }
};

/// Judges equilibrium per region. `elastic`: elastic energy stored because of temperature, 0 without; sets
/// `idle` to the displacement that scales the forces of regions in which nothing acts.
Worst judge_equilibrium(const BodySums& body, const Contact& contact, double elastic, Residuals& out,
                        double& idle) {
  Scales& scales = out.scales;
  Worst worst;
  std::vector<double> scale;
  std::vector<bool> touching;
  idle = 0.0;
  scales.force = scales.contact_force = HUGE_VAL;
  for (std::size_t r = 0; r < body.of_region.size(); ++r) {
    const RegionSums& s = body.of_region[r];
    double weakest = HUGE_VAL, of_contact = 0.0;
    bool touches = false;
    for (std::size_t e = 0; e < contact.entries; ++e) {
      const ContactSums& sums = contact.sums[r * contact.entries + e];
      touches = touches || sums.area > 0.0;
      of_contact += sums.square;
      if (sums.square > 0.0) weakest = std::min(weakest, std::sqrt(sums.square));
    }
    const double stiffness = s.softness > 0.0 ? s.unknowns / s.softness : 0.0;
    // A body of one region under thermal stress may have no other force.
    const double own = body.of_region.size() == 1 ? 2.0 * elastic * stiffness : 0.0;
    double force = std::sqrt(std::max({s.load, s.reaction, s.spring, s.interface, of_contact, own}));
    const double least =
        std::max(least_force * stiffness * std::sqrt(s.moved), body.least_expansion * std::sqrt(s.expansion));
    const double strong = std::max({force, least, tiny});
    if (weakest < HUGE_VAL) force = weak_beside(weakest, force);
    force = std::max(force, least);
    if (stiffness > 0.0) idle = std::max(idle, least_displacement * force / stiffness);
    scale.push_back(force);
    out.unbalanced = larger(out.unbalanced, s.unknowns > 0.0 ? std::sqrt(s.residual) / strong : 0.0);
    touching.push_back(touches);
  }
  for (std::size_t r = 0; r < scale.size(); ++r) {
    const RegionSums& s = body.of_region[r];
    if (s.unknowns == 0.0) continue;  // all of its nodes belong to stiffer regions
    scale[r] = std::max(scale[r], idle * s.unknowns / s.softness);
    worst.take(std::sqrt(s.residual), rounding * std::sqrt(s.stiff), std::max(scale[r], tiny));
    scales.force = std::min(scales.force, scale[r]);
    if (touching[r]) scales.contact_force = std::min(scales.contact_force, scale[r]);
  }
  if (scales.contact_force == HUGE_VAL) scales.contact_force = scales.force;
  if (scale.size() > 1)
    for (const double force : scale)
      scales.weight.push_back(force > scales.force ? scales.force / force : 1.0);
  return worst;
}

/// Judges the balance of forces and moments of each cluster: its remainder loads the parts that hold it.
Worst judge_balance(const Part& part, const BodySums& body, const StiffnessRegions& regions, double idle) {
  Worst worst;
  const bool is_round = part.plane == PlaneState::axisymmetric;
  for (const StiffnessRegions::Cluster& cluster : regions.clusters()) {
    RegionSums s;
    std::vector<std::uint8_t> within(regions.count(), 0);
    for (const std::int32_t r : cluster.regions) {
      const RegionSums& one = body.of_region[r];
      within[r] = 1;
      s.unbalanced = s.unbalanced + one.unbalanced;
      s.moment = s.moment + one.moment;
      s.hold += one.hold;
      s.all += one.all;
      s.moved_all += one.moved_all;
      s.stiff_all += one.stiff_all;
      s.softness += one.softness;
      s.unknowns += one.unknowns;
      s.expansion_all += one.expansion_all;
    }
    for (const auto& [pair, force] : body.between)
      if (within[pair[0]] && regions.bin(pair[1]) > cluster.bin) {
        s.hold += force;
        s.all += force;
      }
    const double stiffness = s.softness > 0.0 ? s.unknowns / s.softness : 0.0;
    const double least =
        std::max({least_force * stiffness * s.moved_all, body.least_expansion * s.expansion_all,
                  stiffness * idle * std::sqrt(s.unknowns)});
    const double scale = std::max({weak_beside(s.hold, s.all), least, tiny});
    // In axisymmetric bodies the first force component and the moments are balanced by themselves.
    if (is_round) s.unbalanced[0] = 0.0;
    const Vector3 moment = is_round ? Vector3{} : s.moment + (-1.0) * cross(cluster.centre, s.unbalanced);
    // Equal elements with equal motion have equal rounding errors, which do not average out in a sum.
    worst.take(norm(s.unbalanced), rounding * s.stiff_all, scale);
    worst.take(norm(moment), rounding * s.stiff_all * cluster.radius, std::max(scale * cluster.radius, tiny));
  }
  return worst;
}

/// Judges the contact residuals, per contact entry and region. `body`: forces and displacements next to which
/// those of the entry may be small.
void judge_contact(const Contact& contact, const BodySums& body, Scales& scales, Certificate& c) {
  Worst penetration, tension, cone, complementarity;
  scales.trace = HUGE_VAL;
  for (std::size_t g = 0; g < contact.sums.size(); ++g) {
    const ContactSums& sums = contact.sums[g];
    const ContactPeaks& peak = contact.peaks[g];
    if (!(sums.area > 0.0)) continue;
    const std::size_t region = g / contact.entries;
    const double largest = body.largest[region];
    const double pressure =
        std::max({peak.pressure, least_share * 0.5 * body.of_region[region].all / sums.area, tiny});
    const double trace = weak_beside(peak.indentation, largest);
    if (peak.indentation > 0.0) scales.trace = std::min(scales.trace, trace);
    const double moved = largest > 0.0 ? 1.0 : 0.0;  // at rest, traces and gaps are exact
    const double length = std::max(trace, tiny), product = std::max(pressure * length * sums.area, tiny);
    penetration.take(peak.penetration, moved * peak.unknown_trace, length);
    tension.take(peak.tension, 0.0, pressure);
    cone.take(peak.cone, 0.0, pressure);
    complementarity.take(sums.products, moved * sums.unknown_product, product);
  }
  if (scales.trace == HUGE_VAL) scales.trace = scales.displacement;
  c.penetration = penetration.residual, c.rounding.penetration = penetration.unknown;
  c.tension = tension.residual;
  c.friction_cone = cone.residual;
  c.complementarity = complementarity.residual, c.rounding.complementarity = complementarity.unknown;
}

}  // namespace

Residuals kkt_residuals(const Space& space, const Traces& traces, const ContactState& state,
                        const BodyForces& forces) {
  const Part& part = space.part();
  std::optional<StiffnessRegions> found;
  if (forces.regions == nullptr) found.emplace(StiffnessRegions::whole(part));
  const StiffnessRegions& regions = found ? *found : *forces.regions;
  Vector force(part.unknowns(), 0.0);
  traces.add_force(state.lambda, 1.0, force);
  Residuals out;
  out.energy = forces.energy;
  Scales& scales = out.scales;
  Certificate& c = out.certificate;
  scales.displacement = space.max_abs(state.u);
  const Contact contact = sum_contact(traces, state, forces, regions, scales.displacement);
  const BodySums body = body_sums(part, state.u, force, forces, regions);
  const WholeSums& whole = body.whole;
  const double no_energy = least_force / whole.softness * whole.moved;
  const double all = std::max(forces.energy, 0.5 * std::abs(whole.internal_work));
  // A freely expanding body stores only the energy due to constraints on its expansion.
  const double elastic = forces.expansion.empty()
                             ? all
                             : std::max(forces.energy - whole.expansion_work + forces.expansion_energy, 0.0);
  const double energy = std::max({weak_beside(elastic, all), no_energy, tiny});
  double idle = 0.0;
  const Worst equilibrium =
                  judge_equilibrium(body, contact, forces.expansion.empty() ? 0.0 : elastic, out, idle),
              balance = judge_balance(part, body, regions, idle);
  c.equilibrium = equilibrium.residual, c.rounding.equilibrium = equilibrium.unknown;
  c.force_balance = balance.residual, c.rounding.force_balance = balance.unknown;
  judge_contact(contact, body, scales, c);

  // Primal minus dual energy. With τ = τ(u) the stored energies add up to R·u; the remainder is the work of
  // the equilibrium residual and the contact products.
  double dual_work = 0.0, unknown_product = 0.0;
  for (const ContactSums& sums : contact.sums) {
    dual_work += sums.dual_work;
    unknown_product += sums.unknown_product;
  }
  const double moved = scales.displacement > 0.0 ? 1.0 : 0.0;
  c.duality_gap = std::abs(dual_work - whole.residual_work) / energy;
  c.rounding.duality_gap = (rounding * whole.stiff_work + moved * unknown_product) / energy;
  return out;
}

}  // namespace kacanov
