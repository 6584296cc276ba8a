// SPDX-License-Identifier: BSD-3-Clause
// Forces of every model entry on the body: reactions, loads and contact.
#include "results/reactions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "linear/springs.hpp"
#include "partition/global_max.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Sums over the points of one contact entry, contiguous for one joint reduction.
struct ContactSums {
  Vector3 normal{}, friction{}, moment{};
  double area = 0.0, sticking = 0.0, slipping = 0.0, open = 0.0;
  double rubbing = 0.0, rubbing_open = 0.0;  // Σ M|λ_t|, and that of open points
};
static_assert(sizeof(ContactSums) == 15 * sizeof(double));

/// Maxima for one joint reduction; minima are stored with reversed sign.
struct ContactPeaks {
  double pressure = 0.0;
  double closed = -std::numeric_limits<double>::max(), first_closed = closed;
};
static_assert(sizeof(ContactPeaks) == 3 * sizeof(double));

/// The structs as numbers.
template <class Struct>
std::span<double> numbers(std::vector<Struct>& structs) {
  return {reinterpret_cast<double*>(structs.data()), structs.size() * sizeof(Struct) / sizeof(double)};
}

/// Returns the force of the obstacle on the body at one point.
ContactSums force_of_point(const Part& part, const ContactState& state, std::size_t i) {
  const ContactPoint& point = part.contact[i];
  const double* friction = &state.lambda.tangential[2 * i];
  ContactSums sums;
  for (const RowEntry& row : part.contact.entries(i)) {
    const Vector3 normal = (-point.mass * state.lambda.normal[i]) * row.trace;
    Vector3 along{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      along = along - (point.mass * friction[k]) * row.tangent[k];
    sums.normal = sums.normal + normal;
    sums.friction = sums.friction + along;
    sums.moment = sums.moment + cross(node_position(part, row.node), normal + along);
  }
  return sums;
}

void add(ContactSums& to, double share, const ContactSums& point) {
  to.normal = to.normal + share * point.normal;
  to.friction = to.friction + share * point.friction;
  to.moment = to.moment + share * point.moment;
}

std::size_t count_contact_entries(const Part& part) {
  std::int32_t count = 0;
  for (const ContactPoint& point : part.contact) count = std::max(count, point.entry + 1);
  for (const PointShare& share : part.contact_shares) count = std::max(count, share.entry + 1);
  return static_cast<std::size_t>(part.node_map.max_all(count));
}

void collect_contact(const Part& part, const ContactState& state, Solution& solution) {
  std::vector<ContactSums> sums(count_contact_entries(part));
  std::vector<ContactPeaks> peaks(sums.size());
  auto joined = part.contact_shares.begin();
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i) {
    const ContactSums force = force_of_point(part, state, i);
    const double mass = part.contact[i].mass, pressure = solution.pressure[i];
    const double* friction = &state.lambda.tangential[2 * i];
    const auto take = [&](std::int32_t entry, double share) {
      ContactSums& sum = sums[entry];
      ContactPeaks& peak = peaks[entry];
      add(sum, share, force);
      const bool touches = pressure > 0.0;
      sum.area += touches ? share * mass : 0.0;
      const double rubbing = share * mass * std::hypot(friction[0], friction[1]);
      sum.rubbing += rubbing;
      sum.rubbing_open += touches ? 0.0 : rubbing;
      const bool sticks = solution.contact_status[i] == ContactStatus::stick;
      (!touches ? sum.open : sticks ? sum.sticking : sum.slipping) += 1.0;
      peak.pressure = std::max(peak.pressure, pressure);
      peak.closed = std::max(peak.closed, -solution.gap[i]);
      peak.first_closed = std::max(peak.first_closed, -part.contact[i].gap);
    };
    const bool shared = joined != part.contact_shares.end() && static_cast<std::size_t>(joined->point) == i;
    if (!shared) take(part.contact[i].entry, 1.0);
    for (; joined != part.contact_shares.end() && static_cast<std::size_t>(joined->point) == i; ++joined)
      take(joined->entry, joined->share);
  }
  part.node_map.sum_all(numbers(sums));
  part.node_map.max_all(numbers(peaks));
  solution.result.contact.clear();
  for (std::size_t e = 0; e < sums.size(); ++e) {
    const ContactSums& sum = sums[e];
    solution.result.contact.push_back(
        {.entry = static_cast<std::int32_t>(e),
         .total = {sum.normal + sum.friction, sum.moment},
         .normal_force = sum.normal,
         .friction_force = sum.friction,
         .area = sum.area,
         .max_pressure = peaks[e].pressure,
         .least_gap = -peaks[e].closed,
         .first_gap = -peaks[e].first_closed,
         .sticking = std::llround(sum.sticking),
         .slipping = std::llround(sum.slipping),
         .open = std::llround(sum.open),
         .open_friction = sum.rubbing > 0.0 ? sum.rubbing_open / sum.rubbing : 0.0});
  }
}

/// Returns R − F at held components, to which contact does not contribute.
class Reactions {
 public:
  Reactions(std::span<const Part::ComponentValue> load, std::span<const double> internal)
      : load_(load), internal_(internal) {}

  /// Calls must be in ascending order of components.
  double at(std::int32_t component) {
    while (!load_.empty() && load_.front().component < component) load_ = load_.subspan(1);
    const bool loaded = !load_.empty() && load_.front().component == component;
    return internal_[component] - (loaded ? load_.front().value : 0.0);
  }

 private:
  std::span<const Part::ComponentValue> load_;
  std::span<const double> internal_;
};

/// Calls put(entry, node, force) for the reactions of supports along prescribed directions at owned nodes.
template <class Put>
void visit_slanting(const Part& part, Reactions reactions, const Put& put) {
  const std::size_t dim = part.dim();
  std::int32_t node = -1;
  Vector3 all{};
  for (const HeldDirection& held : part.directions) {
    if (held.node >= part.owned_nodes()) break;
    for (std::size_t c = 0; c < dim && held.node != node; ++c)
      all[c] = reactions.at(static_cast<std::int32_t>(held.node * dim + c));
    node = held.node;
    put(held.entry, node, dot(held.direction, all) * held.direction);
  }
}

void collect_reactions(const Part& part, std::span<const double> u, Reactions reactions, Result& result) {
  std::int32_t count = 0;
  for (const HeldDirection& held : part.directions) count = std::max(count, held.entry + 1);
  for (const NodeSpring& spring : part.springs) count = std::max(count, spring.entry + 1);
  for (const Support& support : part.supports) count = std::max(count, support.entry + 1);
  std::vector<Resultant> sums(static_cast<std::size_t>(part.node_map.max_all(count)));
  std::vector<double> there(sums.size(), 0.0);  // whether the entry holds anything
  const auto put = [&](std::int32_t entry, std::int32_t node, const Vector3& force) {
    Resultant& sum = sums[entry];
    sum.force = sum.force + force;
    sum.moment = sum.moment + cross(node_position(part, node), force);
    there[entry] = 1.0;
  };
  visit_slanting(part, reactions, put);
  for (auto first = part.supports.begin(); first != part.supports.end();) {
    const auto last = std::find_if(first, part.supports.end(), [&](const Support& s) {
      return s.node != first->node || s.axis != first->axis;
    });
    const double all = reactions.at(first->node * part.dim() + first->axis);
    Vector3 force{};
    force[first->axis] = all / static_cast<double>(last - first);
    for (; first != last; ++first) put(first->entry, first->node, force);
  }
  for (const NodeSpring& spring : part.springs) {
    if (spring.node >= part.owned_nodes()) break;
    put(spring.entry, spring.node, spring_force(spring, part, u));
  }
  part.node_map.sum_all(numbers(sums));
  part.node_map.max_all(there);
  result.reaction.clear();
  for (std::size_t e = 0; e < sums.size(); ++e)
    if (there[e] > 0.0) result.reaction.push_back({static_cast<std::int32_t>(e), sums[e]});
}

}  // namespace

void collect_entries(const Part& part, const ContactState& state, const LoadPath& path,
                     std::span<const double> internal, Solution& solution) {
  collect_contact(part, state, solution);
  collect_reactions(part, state.u, Reactions(path.load(), internal), solution.result);
  solution.result.load.clear();
  for (const AppliedLoad& load : part.applied) {
    const double factor = path.factor_of(load.entry);
    solution.result.load.push_back({load.entry, {factor * load.total.force, factor * load.total.moment}});
  }
  if (part.plane != PlaneState::axisymmetric) return;
  // In axisymmetric bodies moments cancel.
  for (ContactTotals& entry : solution.result.contact) entry.total.moment = {};
  for (auto* list : {&solution.result.reaction, &solution.result.load})
    for (BoundaryTotals& entry : *list) entry.total.moment = {};
}

}  // namespace kacanov
