// SPDX-License-Identifier: BSD-3-Clause
// Checks the lengths, indices and order of each field of a part.
#include "partition/check_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

[[noreturn]] void refuse(const std::string& field, const std::string& what) {
  throw InputError("the part's " + field + " " + what);
}

void expect(bool holds, const char* field, const char* what) {
  if (!holds) refuse(field, what);
}

void expect_length(const char* field, std::size_t length, std::size_t expected) {
  if (length != expected)
    refuse(field, "have " + std::to_string(length) + " entries, expected " + std::to_string(expected));
}

/// Compares a local count with the total over all ranks; on a single rank they must be equal.
void expect_total(const char* field, std::int64_t total, std::size_t here, int ranks) {
  const auto mine = static_cast<std::int64_t>(here);
  expect(ranks == 1 ? total == mine : total >= mine, field, "are more or fewer than all");
}

template <class Values>
void expect_indices(const char* field, const Values& values, std::size_t count) {
  for (const auto& value : values) {
    const std::int64_t index = value;
    if (index < 0 || static_cast<std::size_t>(index) >= count)
      refuse(field, "name " + std::to_string(index) + " of " + std::to_string(count));
  }
}

/// Checks that the components are strictly ascending and below `count`.
void expect_components(const char* field, const std::vector<Part::ComponentValue>& entries,
                       std::size_t count) {
  std::int64_t before = -1;
  for (const Part::ComponentValue& entry : entries) {
    if (entry.component <= before || static_cast<std::size_t>(entry.component) >= count)
      refuse(field, "name component " + std::to_string(entry.component) + " of " + std::to_string(count) +
                        " behind " + std::to_string(before));
    before = entry.component;
  }
}

void check_map(const IndexMap& map, std::size_t nodes, int rank, int ranks) {
  expect(map.owned >= 0 && static_cast<std::size_t>(map.owned) <= nodes, "node map",
         "owns more than there is");
  expect_length("ghosts", map.ghosts.size(), nodes - static_cast<std::size_t>(map.owned));
  expect_length("first nodes", map.starts.size(), static_cast<std::size_t>(ranks) + 1);
  expect(map.starts.front() == 0 && std::is_sorted(map.starts.begin(), map.starts.end()), "first nodes",
         "are out of order");
  expect(map.starts[rank + 1] - map.starts[rank] == map.owned, "first nodes", "do not fit the owned ones");
  expect_indices("ghosts", map.ghosts, static_cast<std::size_t>(map.total()));
  expect_indices("shared nodes", map.shared, nodes);
  int before = -1;
  for (const IndexMap::Neighbour& neighbour : map.neighbours) {
    expect(neighbour.rank > before && neighbour.rank < ranks && neighbour.rank != rank, "neighbours",
           "are no other ranks in order");
    before = neighbour.rank;
    for (const auto* list : {&neighbour.shared, &neighbour.send, &neighbour.receive})
      expect_indices("neighbours", *list, nodes);
  }
}

void check_element_index(const IndexRuns& index, std::size_t elements) {
  expect(index.count >= 0 && (index.count == 0) == index.runs.empty(), "element numbers", "have no runs");
  expect_length("element numbers", index.size(), elements);
  std::int64_t position = -1, end = 0;
  for (const IndexRuns::Run& run : index.runs) {
    expect(run.position > position && run.position < index.count && run.first >= end, "element numbers",
           "are out of order");
    expect(position >= 0 || run.position == 0, "element numbers", "do not begin with the first");
    position = run.position, end = run.first;
  }
}

/// More than the largest possible case file can have.
constexpr std::int32_t most_entries = 1 << 22;

/// Checks load curves: at least two times, with factors for every entry that is referenced.
void check_steps(const Part& part, std::size_t unknowns) {
  if (part.steps.empty()) return;
  const std::size_t boundary = part.steps.front().boundary.size(),
                    contact = part.steps.front().contact.size();
  expect(part.steps.size() > 1, "load curves", "have one point");
  double before = -HUGE_VAL;
  for (const LoadFactors& factors : part.steps) {
    expect_length("load curves", factors.boundary.size(), boundary);
    expect_length("load curves", factors.contact.size(), contact);
    expect(factors.time > before, "load curves", "go back in time");
    before = factors.time;
  }
  std::int32_t component = 0;
  for (const EntryForce& force : part.forces) {
    expect(force.component >= component && static_cast<std::size_t>(force.component) < unknowns, "forces",
           "are out of order");
    component = force.component;
    expect_indices("forces", std::array{force.entry}, boundary);
  }
  expect_length("entries of prescribed components", part.prescribed_by.size(), part.prescribed.size());
  for (std::size_t k = 0; k < part.prescribed.size(); ++k)  // components on the axis have no entry
    if (part.prescribed_by[k] != -1 || part.prescribed[k].value != 0.0)
      expect_indices("entries of prescribed components", std::array{part.prescribed_by[k]}, boundary);
  for (const ContactPoint& point : part.contact)
    expect_indices("contact points", std::array{point.entry}, contact);
}

void check_contact(const Part& part, std::size_t nodes, int ranks) {
  const ConstraintRows& contact = part.contact;
  expect(contact.consistent(), "contact points", "do not fit their rows");
  expect_length("numbers of contact points", part.contact_index.size(), contact.size());
  expect_indices("numbers of contact points", part.contact_index,
                 static_cast<std::size_t>(part.total_contact));
  expect(part.owned_contact >= 0 && static_cast<std::size_t>(part.owned_contact) <= contact.size(),
         "contact points", "are fewer than the owned ones");
  expect_total("contact points", part.total_contact, static_cast<std::size_t>(part.owned_contact), ranks);
  for (std::size_t i = 0; i < contact.size(); ++i) {
    const ContactPoint& point = contact[i];
    expect_indices("contact points", std::array{point.node}, nodes);
    expect(point.loose_piece >= -1 && point.loose_piece < std::ssize(part.loose_pieces), "contact points",
           "belong to a piece that is not there");
    expect(
        point.entry >= 0 && point.entry < most_entries && point.tangents >= 0 && point.tangents < part.dim(),
        "contact points", "have tangents or an entry that cannot be");
    for (const RowEntry& entry : contact.entries(i))
      expect_indices("contact rows", std::array{entry.node}, nodes);
  }
}

/// Checks the data behind the totals of entries.
void check_entries(const Part& part) {
  const auto owned = static_cast<std::size_t>(part.owned_nodes()),
             axes = static_cast<std::size_t>(part.dim());
  const std::size_t entries = part.steps.empty() ? most_entries : part.steps.front().boundary.size();
  const std::size_t contacts = part.steps.empty() ? most_entries : part.steps.front().contact.size();
  const Support* before = nullptr;
  for (const Support& support : part.supports) {
    expect_indices("supports", std::array{support.node}, owned);
    expect_indices("supports", std::array{support.axis}, axes);
    expect_indices("supports", std::array{support.entry}, entries);
    expect(before == nullptr || before->node < support.node ||
               (before->node == support.node && before->axis <= support.axis),
           "supports", "are out of order");
    before = &support;
  }
  std::int32_t point = 0;
  for (const PointShare& share : part.contact_shares) {
    expect_indices("shares of contact points", std::array{share.point},
                   static_cast<std::size_t>(part.owned_contact));
    expect_indices("shares of contact points", std::array{share.entry}, contacts);
    expect(share.point >= point, "shares of contact points", "are out of order");
    point = share.point;
  }
  std::int32_t node = 0;
  for (const HeldDirection& held : part.directions) {
    expect_indices("held directions", std::array{held.node}, part.nodes());
    expect_indices("held directions", std::array{held.entry}, entries);
    expect(held.node >= node, "held directions", "are out of order");
    node = held.node;
    expect(directions_of(part.directions, node).size() <= axes, "held directions", "are too many");
    for (const double value : held.direction)
      expect(std::abs(value) <= 1.0 + 1e-9, "held directions", "are not of unit length");
    expect(std::isfinite(held.value), "held directions", "are not finite");
  }
  node = 0;
  for (const NodeSpring& spring : part.springs) {
    expect_indices("springs", std::array{spring.node}, part.nodes());
    expect_indices("springs", std::array{spring.entry}, entries);
    expect(spring.node >= node, "springs", "are out of order");
    node = spring.node;
    for (const Vector3& row : spring.stiffness)
      for (const double value : row) expect(std::isfinite(value), "springs", "are not finite");
  }
  for (const ThermalPressure& thermal : part.thermal) {
    expect_indices("temperatures", std::array{thermal.entry}, entries);
    const std::size_t corners = cell(part.type).corners;
    if (thermal.of_element.size() != part.element_count())
      expect_length("temperatures", thermal.of_element.size(), (1 + corners) * part.element_count());
  }
  for (const AppliedLoad& load : part.applied)
    expect_indices("loads of entries", std::array{load.entry}, entries);
}

}  // namespace

void check_part(const Part& part, int rank, int ranks) {
  expect(std::any_of(cells().begin(), cells().end(),
                     [&](const Cell& c) { return element_type(c) == part.type; }),
         "element type", "does not exist");
  expect(part.plane == PlaneState::strain || (part.dim() == 2 && (part.plane == PlaneState::stress ||
                                                                  part.plane == PlaneState::axisymmetric)),
         "plane", "does not exist in this dimension");
  expect(part.thickness > 0.0 && std::isfinite(part.thickness), "thickness", "is no length");
  const std::size_t dim = part.dim(), nodes = part.nodes();
  const std::size_t per_element = nodes_per_element(part.type);
  expect_length("coordinates", part.coordinates.size(), nodes * dim);
  expect_indices("elements", part.elements, nodes);
  expect(part.elements.size() % per_element == 0, "elements", "are not whole");
  const std::size_t elements = part.elements.size() / per_element;
  check_element_index(part.element_index, elements);
  expect_total("elements", part.total_elements, elements, ranks);
  if (!part.node_tags.empty()) expect_length("node tags", part.node_tags.size(), nodes);
  if (!part.element_tags.empty()) expect_length("element tags", part.element_tags.size(), elements);
  check_map(part.node_map, nodes, rank, ranks);
  expect_indices("node numbers", part.node_index, static_cast<std::size_t>(part.node_map.total()));

  expect(!part.laws.empty(), "laws", "are none");
  for (const Law& law : part.laws)
    if (const std::string fault = validate(law); !fault.empty()) refuse("laws", "are wrong: " + fault);
  for (const Law& law : part.laws) {
    const double stiffness = law.secant(0.0);
    expect(std::isfinite(stiffness) && stiffness > 0.0, "laws", "have no stiffness that is a number > 0");
  }
  if (!part.law_of_element.empty()) expect_length("laws of elements", part.law_of_element.size(), elements);
  expect_indices("laws of elements", part.law_of_element, part.laws.size());

  const std::size_t unknowns = nodes * dim;
  expect_components("loads", part.load, unknowns);
  expect_length("held components", part.held.size(), unknowns);
  expect_components("prescribed components", part.prescribed, unknowns);
  const auto held = [&](const Part::ComponentValue& entry) { return part.held[entry.component] != 0; };
  expect(std::all_of(part.prescribed.begin(), part.prescribed.end(), held), "prescribed components",
         "are free");
  expect_length("prescribed components", part.prescribed.size(),
                unknowns - static_cast<std::size_t>(std::count(part.held.begin(), part.held.end(), 0)));

  check_contact(part, nodes, ranks);
  check_steps(part, unknowns);
  check_entries(part);
  expect_length("numbers of probes", part.probe_index.size(), part.probes.size());
  expect_total("probes", part.total_probes, part.probes.size(), ranks);
  expect_indices("numbers of probes", part.probe_index, static_cast<std::size_t>(part.total_probes));
  for (const Probe& probe : part.probes) expect_indices("probes", std::array{probe.element}, elements);
  expect(part.loose_modes >= 0, "loose modes", "are fewer than none");
  if (!part.start.empty()) expect_length("start", part.start.size(), unknowns);
  const auto finite = [](double v) { return std::isfinite(v); };
  expect(std::all_of(part.start.begin(), part.start.end(), finite), "start", "is not finite");
}

}  // namespace kacanov
