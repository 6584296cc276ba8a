// SPDX-License-Identifier: BSD-3-Clause
// What has to hold of a part that comes from a file before its indices are followed.
#include "parallel/part_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace kacanov {
namespace {

/// Whether the byte of a bool is one of the two it may be.
bool sound(const bool& value) {
  std::uint8_t byte = 0;
  static_assert(sizeof value == sizeof byte);
  std::memcpy(&byte, &value, sizeof byte);
  return byte <= 1;
}

/// Collects the first thing that is wrong.
class Check {
 public:
  const std::string& fault() const noexcept { return fault_; }
  bool good() const noexcept { return fault_.empty(); }

  void that(bool holds, const std::string& what) {
    if (good() && !holds) fault_ = what;
  }
  void length(const char* name, std::size_t entries, std::size_t expected) {
    that(entries == expected, std::string(name) + " has " + std::to_string(entries) + " entries, expected " +
                                  std::to_string(expected));
  }
  /// None, or as many as that.
  void length_if_any(const char* name, std::size_t entries, std::size_t expected) {
    if (entries > 0) length(name, entries, expected);
  }
  template <class T>
  void indices(const char* name, const T& values, std::int64_t end) {
    std::size_t place = 0;
    for (const std::int64_t value : values) {
      if (good() && (value < 0 || value >= end))
        fault_ = std::string(name) + "[" + std::to_string(place) + "] is " + std::to_string(value) +
                 ", expected a number from 0 to " + std::to_string(end - 1);
      ++place;
    }
  }
  void numbers(const char* name, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (good() && !std::isfinite(values[i]))
        fault_ = std::string(name) + "[" + std::to_string(i) + "] is no finite number";
  }
  void one_of(const char* name, std::int64_t value, std::int64_t end) {
    that(value >= 0 && value < end, std::string(name) + " is " + std::to_string(value) +
                                        ", expected a number from 0 to " + std::to_string(end - 1));
  }

 private:
  std::string fault_;
};

constexpr std::int64_t any_index = std::int64_t{std::numeric_limits<std::int32_t>::max()} + 1;

bool known_type(ElementType type) {
  const auto types = element_types();
  return std::find(types.begin(), types.end(), type) != types.end();
}

void check_halo(Check& check, const IndexMap& halo, std::size_t nodes, int rank, int ranks) {
  const std::size_t here = rank;
  check.length("halo.starts", halo.starts.size(), static_cast<std::size_t>(ranks) + 1);
  if (!check.good()) return;
  check.that(halo.starts[0] == 0 && std::is_sorted(halo.starts.begin(), halo.starts.end()),
             "halo.starts does not ascend from 0");
  check.that(halo.owned >= 0 && halo.starts[here + 1] - halo.starts[here] == halo.owned,
             "halo.owned is not what halo.starts says");
  check.that(static_cast<std::size_t>(halo.owned) + halo.ghosts.size() == nodes,
             "owned nodes and ghosts are not all nodes");
  check.indices("halo.ghosts", halo.ghosts, halo.starts.back());
  check.indices("halo.shared", halo.shared, static_cast<std::int64_t>(nodes));
  int before = -1;
  for (const IndexMap::Neighbour& n : halo.neighbours) {
    check.that(n.rank > before && n.rank < ranks && n.rank != rank,
               "halo.neighbours: their ranks do not ascend, or do not exist");
    before = n.rank;
    check.indices("halo.neighbours.shared", n.shared, static_cast<std::int64_t>(nodes));
    check.indices("halo.neighbours.send", n.send, halo.owned);
    check.indices("halo.neighbours.receive", n.receive, static_cast<std::int64_t>(nodes));
  }
}

void check_runs(Check& check, const IndexRuns& index, std::int64_t total) {
  check.that(index.count >= 0 && index.runs.empty() == (index.count == 0),
             "element_index: its count is wrong");
  std::int64_t next = 0, above = 0;
  for (std::size_t r = 0; r < index.runs.size() && check.good(); ++r) {
    const auto& run = index.runs[r];
    const std::int64_t end = r + 1 < index.runs.size() ? index.runs[r + 1].position : index.count;
    check.that(run.position == next && end > next && run.first >= above,
               "element_index: run " + std::to_string(r) + " does not follow the one before");
    next = end;
    above = run.first + (end - run.position);
    check.that(above <= total, "element_index: run " + std::to_string(r) + " goes beyond the last element");
  }
}

void check_values(Check& check, const char* name, std::span<const Part::ComponentValue> values,
                  std::size_t unknowns) {
  std::int64_t before = -1;
  for (const Part::ComponentValue& entry : values) {
    check.that(entry.component > before && static_cast<std::size_t>(entry.component) < unknowns &&
                   std::isfinite(entry.value),
               std::string(name) + ": component " + std::to_string(entry.component) +
                   " is out of place, or its value no number");
    before = entry.component;
  }
}

/// Whether every point has entries, and all entries belong to one.
bool whole(const ConstraintRows& rows) {
  bool good = true;
  ConstraintRows::exchange(rows, [&](const auto& points, const auto& start, const auto& entries) {
    good = start.size() == points.size() + 1 && start.front() == 0 && start.back() == entries.size();
    for (std::size_t i = 0; good && i < points.size(); ++i) good = start[i] < start[i + 1];
  });
  return good;
}

void check_rows(Check& check, const ConstraintRows& rows, std::size_t nodes) {
  check.that(whole(rows), "contact: its rows do not begin and end where they should");
  if (!check.good()) return;
  const auto end = static_cast<std::int64_t>(nodes);
  for (std::size_t i = 0; i < rows.size() && check.good(); ++i) {
    const ContactPoint& point = rows[i];
    const std::string name = "contact[" + std::to_string(i) + "]";
    check.one_of((name + ".node").c_str(), point.node, end);
    check.one_of((name + ".entry").c_str(), point.entry, any_index);
    check.one_of((name + ".tangents").c_str(), point.tangents, 3);
    check.numbers((name + ".normal").c_str(), point.normal);
    check.that(std::isfinite(point.gap) && point.mass > 0.0 && std::isfinite(point.mass) &&
                   point.tresca >= 0.0 && point.coulomb >= 0.0,
               name + ": its gap, mass or friction is no number it can have");
    check.that(sound(point.since_step), name + ".since_step is neither true nor false");
    for (const RowEntry& entry : rows.entries(i)) {
      check.one_of((name + ".entries.node").c_str(), entry.node, end);
      check.numbers((name + ".entries.normal").c_str(), entry.normal);
      check.numbers((name + ".entries.trace").c_str(), entry.trace);
      for (const Vector3& tangent : entry.tangent)
        check.numbers((name + ".entries.tangent").c_str(), tangent);
    }
  }
}

void check_laws(Check& check, const Part& part) {
  check.that(!part.laws.empty(), "there are no laws");
  for (std::size_t i = 0; i < part.laws.size() && check.good(); ++i) {
    const Law& law = part.laws[i];
    const std::string wrong = validate(law), name = "laws[" + std::to_string(i) + "].";
    check.that(wrong.empty(), name + wrong);
    check.that(sound(law.mean_dilatation) && law.argument <= Law::Argument::squared,
               name + "argument or mean_dilatation is no value they have");
  }
  check.length_if_any("law_of_element", part.law_of_element.size(), part.element_count());
  check.indices("law_of_element", part.law_of_element, static_cast<std::int64_t>(part.laws.size()));
}

void check_mesh_arrays(Check& check, const Part& part) {
  const std::size_t nodes = part.nodes(), dim = part.dim();
  check.length("coordinates", part.coordinates.size(), nodes * dim);
  check.numbers("coordinates", part.coordinates);
  check.indices("node_index", part.node_index, any_index);
  check.that(part.total_elements >= 0 && part.total_elements < any_index, "total_elements is out of range");
  check_runs(check, part.element_index, part.total_elements);
  check.length("elements", part.elements.size(),
               part.element_count() * static_cast<std::size_t>(nodes_per_element(part.type)));
  check.indices("elements", part.elements, static_cast<std::int64_t>(nodes));
  check.length_if_any("node_tags", part.node_tags.size(), nodes);
  check.length_if_any("element_tags", part.element_tags.size(), part.element_count());
}

void check_conditions(Check& check, const Part& part) {
  const std::size_t unknowns = part.coordinates.size();
  check_values(check, "load", part.load, unknowns);
  check_values(check, "prescribed", part.prescribed, unknowns);
  check.length("held", part.held.size(), unknowns);
  const auto held = std::count_if(part.held.begin(), part.held.end(), [](std::uint8_t h) { return h != 0; });
  check.length("prescribed", part.prescribed.size(), static_cast<std::size_t>(held));
  if (!check.good()) return;
  for (const Part::ComponentValue& entry : part.prescribed)
    check.that(part.held[static_cast<std::size_t>(entry.component)] != 0,
               "prescribed: component " + std::to_string(entry.component) + " is not held");
  check.length_if_any("start", part.start.size(), unknowns);
  check.length("prescribed_by", part.prescribed_by.size(), part.steps.empty() ? 0 : part.prescribed.size());
  for (const LoadFactors& step : part.steps) {
    const LoadFactors& first = part.steps.front();
    check.that(step.boundary.size() == first.boundary.size() && step.contact.size() == first.contact.size(),
               "steps: they have not the same number of factors");
    check.numbers("steps.boundary", step.boundary);
    check.numbers("steps.contact", step.contact);
  }
  const std::size_t entries = part.steps.empty() ? 0 : part.steps.front().boundary.size();
  check.indices("prescribed_by", part.prescribed_by, static_cast<std::int64_t>(entries));
  for (const EntryForce& force : part.forces) {
    check.one_of("forces.component", force.component, static_cast<std::int64_t>(unknowns));
    check.one_of("forces.entry", force.entry, static_cast<std::int64_t>(entries));
  }
  for (const ContactPoint& point : part.contact)
    check.that(part.steps.empty() || (point.entry >= 0 && static_cast<std::size_t>(point.entry) <
                                                              part.steps.front().contact.size()),
               "steps: a contact entry has no factor");
  check.numbers("start", part.start);
}

void check_contact(Check& check, const Part& part) {
  check_rows(check, part.contact, part.nodes());
  check.that(part.owned_contact >= 0 && static_cast<std::size_t>(part.owned_contact) <= part.contact.size(),
             "owned_contact is out of range");
  check.that(part.total_contact >= 0 && part.total_contact < any_index, "total_contact is out of range");
  check.length("contact_index", part.contact_index.size(), part.contact.size());
  check.indices("contact_index", part.contact_index, part.total_contact);
}

void check_probes(Check& check, const Part& part) {
  check.length("probe_index", part.probe_index.size(), part.probes.size());
  check.that(part.total_probes >= 0, "total_probes is below 0");
  check.indices("probe_index", part.probe_index, part.total_probes);
  for (const Probe& probe : part.probes) {
    check.one_of("probes.element", probe.element, static_cast<std::int64_t>(part.element_count()));
    check.numbers("probes.weights", probe.weights);
  }
}

}  // namespace

std::string fault(const Part& part, int rank, int ranks) {
  Check check;
  check.that(known_type(part.type), "there is no such type of elements");
  if (!check.good()) return check.fault();
  check_mesh_arrays(check, part);
  check_halo(check, part.halo, part.nodes(), rank, ranks);
  check_laws(check, part);
  check_conditions(check, part);
  check_contact(check, part);
  check_probes(check, part);
  check.that(part.loose_modes >= 0, "loose_modes is below 0");
  check.that(sound(part.wide_contact), "wide_contact is neither true nor false");
  return check.fault();
}

std::string fault(const Problem& boundary, std::span<const std::int32_t> boundary_nodes) {
  Check check;
  const Mesh& mesh = boundary.mesh;
  check.that(known_type(mesh.type), "there is no such type of elements");
  if (!check.good()) return check.fault();
  const std::size_t nodes = mesh.node_count();
  const auto end = static_cast<std::int64_t>(nodes);
  check.length("coordinates", mesh.coordinates.size(), nodes * static_cast<std::size_t>(mesh.dim()));
  check.numbers("coordinates", mesh.coordinates);
  check.length("boundary_nodes", boundary_nodes.size(), nodes);
  check.indices("boundary_nodes", boundary_nodes, any_index);
  check.length_if_any("node_tags", mesh.node_tags.size(), nodes);
  check.length("elements", mesh.elements.size(),
               mesh.element_count() * static_cast<std::size_t>(nodes_per_element(mesh.type)));
  check.indices("elements", mesh.elements, end);
  check.length_if_any("element_tags", mesh.element_tags.size(), mesh.element_count());
  check.length("facets", mesh.facets.size(),
               mesh.facet_count() * static_cast<std::size_t>(nodes_per_facet(mesh.type)));
  check.indices("facets", mesh.facets, end);
  check.length_if_any("facet_element", mesh.facet_element.size(), mesh.facet_count());
  if (!mesh.elements.empty())
    check.indices("facet_element", mesh.facet_element, static_cast<std::int64_t>(mesh.element_count()));
  for (const Group& group : mesh.groups) {
    check.one_of("groups.dimension", group.dimension, mesh.dim() + 1);
    check.indices("groups.members", group.members,
                  group.dimension == mesh.dim()       ? any_index
                  : group.dimension == mesh.dim() - 1 ? static_cast<std::int64_t>(mesh.facet_count())
                                                      : end);
  }
  check_rows(check, boundary.contact, nodes);
  return check.fault();
}

std::string disagreement(const Part& part) {
  const IndexMap& halo = part.halo;
  const std::size_t ranks = halo.ranks;
  // Of every rank, what it thinks it shares with, sends to and receives from each other one.
  std::vector<double> lengths(3 * ranks * ranks, 0.0);
  const auto at = [&](int from, int to, std::size_t which) -> double& {
    return lengths[(static_cast<std::size_t>(from) * ranks + static_cast<std::size_t>(to)) * 3 + which];
  };
  for (const IndexMap::Neighbour& n : halo.neighbours) {
    at(halo.rank, n.rank, 0) = static_cast<double>(n.shared.size());
    at(halo.rank, n.rank, 1) = static_cast<double>(n.send.size());
    at(halo.rank, n.rank, 2) = static_cast<double>(n.receive.size());
  }
  halo.sum_all(lengths);
  for (int a = 0; a < halo.ranks; ++a)
    for (int b = 0; b < halo.ranks; ++b)
      if (at(a, b, 0) != at(b, a, 0) || at(a, b, 1) != at(b, a, 2))
        return "parts " + std::to_string(std::min(a, b)) + " and " + std::to_string(std::max(a, b)) +
               " do not agree about the nodes they share";
  std::vector<double> totals(halo.starts.begin(), halo.starts.end());
  totals.push_back(static_cast<double>(part.total_elements));
  totals.push_back(static_cast<double>(part.total_contact));
  std::vector<double> sums = totals;
  halo.sum_all(sums);
  bool differ = false;
  for (std::size_t i = 0; i < sums.size(); ++i) differ = differ || sums[i] != halo.ranks * totals[i];
  if (halo.any(differ))
    return "the parts do not agree about the numbers of nodes, elements or contact points";
  if (halo.sum_all(static_cast<std::int64_t>(part.element_count())) != part.total_elements)
    return "the elements of all parts are not as many as the mesh has";
  if (halo.sum_all(std::int64_t{part.owned_contact}) != part.total_contact)
    return "the contact points of all parts are not as many as there are";
  return {};
}

}  // namespace kacanov
