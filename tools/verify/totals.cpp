// SPDX-License-Identifier: BSD-3-Clause
// Compares totals of a result: forces, moments and contact states of entries, displacements of probes.
#include "verify/totals.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace kacanov::verify {
namespace {

using nlohmann::json;

/// Bound on the round-off of a sum in double, relative to its terms (theory: rounding).
constexpr Real share_of_terms = 4e-15L;
/// Largest number of terms per node in a sum: tet4 elements around it.
constexpr Real elements_of_node = 32;
constexpr Real epsilon_of_doubles = std::numeric_limits<double>::epsilon();

std::string name_of_entry(const json& document, const char* list, std::size_t number) {
  return document.at(list).at(number).value("name", std::string(list) + "[" + std::to_string(number) + "]");
}

/// Collects differences between the members of one object of the result and the recomputed values.
class Notes {
 public:
  Notes(const json& object, std::string prefix, std::vector<Difference>& out)
      : object_(object), prefix_(std::move(prefix)), out_(out) {}

  void number(const char* key, Real found, Real rounding) {
    compare(prefix_ + key, at(key), found, rounding);
  }
  void vector(const char* key, const Vec& found, Real rounding) {
    const json& said = at(key);
    for (std::size_t c = 0; c < said.size(); ++c)
      compare(prefix_ + key + "[" + "xyz"[c] + "]", said.at(c), found.at(c), rounding);
  }

 private:
  const json& at(const char* key) const {
    if (!object_.contains(key)) throw Failure("result.json: expected " + prefix_ + key);
    return object_.at(key);
  }
  void compare(const std::string& name, const json& value, Real found, Real rounding) {
    const Real said = value.is_number() ? Real(value.get<double>()) : HUGE_VALL;
    if (!(std::abs(said - found) <= rounding)) out_.push_back({name, said, found, rounding});
  }

  const json& object_;
  std::string prefix_;
  std::vector<Difference>& out_;
};

const json& entry_of(const json& result, const char* list, const std::string& name) {
  if (!result.contains(list) || !result.at(list).contains(name))
    throw Failure("result.json: expected " + std::string(list) + "." + name);
  return result.at(list).at(name);
}

Real largest_of(const std::vector<Vec>& u) {
  Real most = 0;
  for (const Vec& v : u)
    for (const Real component : v) most = larger(most, std::abs(component));
  return most;
}

/// Forces of an obstacle on the body, and the contact states of its nodes.
struct ContactTotal {
  Resultant normal, friction;
  Real area = 0, whole = 0, pressure = 0;
  Real least_gap = HUGE_VALL, unknown_gap = 0;
  std::array<std::size_t, 3> states{};  ///< open, sticking, slipping
};

std::vector<ContactTotal> contact_totals(const Problem& problem, const Answer& answer) {
  std::vector<ContactTotal> totals(problem.contact_factor.size());
  const Real most = largest_of(answer.u);
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const ContactRow& row = problem.rows[i];
    const Real lambda = answer.pressure[i];
    Real open = row.gap;
    for (const ContactRow::Share& share : row.shares) open -= dot(share.normal, answer.u[share.node]);
    for (const auto& [entry, mass] : row.parts) {
      ContactTotal& total = totals.at(entry);
      const Real share = row.shares.size() == 1 ? mass : mass / static_cast<Real>(row.shares.size());
      for (const ContactRow::Share& of : row.shares) {
        const Vec& x = problem.mesh.nodes[of.node];
        const Real weight = row.shares.size() == 1 ? mass : mass * norm(of.normal);
        add_force(total.normal, x, -mass * lambda * of.normal, mass * std::abs(lambda));
        add_force(total.friction, x, weight * answer.traction[i], share * norm(answer.traction[i]));
      }
      if (lambda > 0) total.area += mass;
      total.whole += mass;
      total.pressure = larger(total.pressure, lambda);
      total.least_gap = std::min(total.least_gap, open);
      total.unknown_gap = larger(total.unknown_gap, 3e-16L * (most + std::abs(row.gap)) + row.unknown_gap);
      ++total.states.at(lambda > 0 ? static_cast<std::size_t>(answer.status[i]) : 0);
    }
  }
  return totals;
}

void compare_contact(const json& document, const json& result, const Problem& problem, const Answer& answer,
                     std::vector<Difference>& out) {
  const std::vector<ContactTotal> totals = contact_totals(problem, answer);
  // Masses and normals are sums over facets, and normals of joined points agree to this accuracy.
  constexpr Real share = 1e-9L;
  for (std::size_t e = 0; e < totals.size(); ++e) {
    const ContactTotal& total = totals[e];
    if (total.whole == 0) continue;
    const std::string name = name_of_entry(document, "contact", e);
    Notes notes(entry_of(result, "contact", name), "contact." + name + ".", out);
    const Real normal = total.normal.size, friction = total.friction.size;
    const bool turns = !problem.mesh.is_round;
    notes.vector("force", total.normal.force + total.friction.force, share * (normal + friction));
    notes.vector("normal_force", total.normal.force, share * normal);
    notes.vector("friction_force", total.friction.force, share * friction);
    notes.vector("moment", turns ? total.normal.moment + total.friction.moment : Vec{},
                 share * (total.normal.arms + total.friction.arms));
    notes.number("area", total.area, share * total.whole);
    notes.number("max_pressure", total.pressure, 0);
    notes.number("least_gap", total.least_gap, 4 * total.unknown_gap);
    notes.number("open", static_cast<Real>(total.states[0]), 0);
    notes.number("sticking", static_cast<Real>(total.states[1]), 0);
    notes.number("slipping", static_cast<Real>(total.states[2]), 0);
  }
}

/// Number of free directions of a node other than the normal of its contact row.
std::size_t free_tangents(const Problem& problem, Index node) {
  const auto& held = problem.held[static_cast<std::size_t>(node)];
  auto given = static_cast<std::size_t>(std::count(held.begin(), held.end(), true));
  if (problem.mesh.dim() == 2 && held[2]) --given;
  if (const auto there = problem.directions.find(node); there != problem.directions.end())
    given += there->second.size();
  const auto dim = static_cast<std::size_t>(problem.mesh.dim());
  return given + 1 < dim ? dim - given - 1 : 0;
}

void compare_counts(const json& result, const Problem& problem, const Answer& answer,
                    std::vector<Difference>& out) {
  std::size_t active = 0, slip = 0;
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const ContactRow& row = problem.rows[i];
    if (answer.pressure[i] > 0) ++active;
    const bool rubs = row.friction && (row.shares.size() > 1 || free_tangents(problem, row.node) > 0);
    if (rubs && answer.status[i] == 2) ++slip;
  }
  Notes notes(result, "", out);
  notes.number("active_nodes", static_cast<Real>(active), 0);
  notes.number("slip_nodes", static_cast<Real>(slip), 0);
}

/// Returns the reaction of each boundary entry with supports; nothing if it supports no node.
std::vector<std::optional<Resultant>> reactions(const Problem& problem, const Answer& answer,
                                                const BodyResponse& body) {
  std::vector<std::optional<Resultant>> sums(problem.applied.size());
  const auto put = [&](std::size_t entry, Index node, const Vec& force, Real size) {
    if (entry >= sums.size()) return;
    if (!sums[entry]) sums[entry].emplace();
    add_force(*sums[entry], problem.mesh.nodes[static_cast<std::size_t>(node)], force, size);
  };
  for (const auto& [node, supports] : problem.supports) {
    const auto n = static_cast<std::size_t>(node);
    const Vec all = body.internal[n] - problem.load[n];
    const Real size = body.size[n] + norm(problem.load[n]);
    // Entries that prescribe the same component share the reaction equally; the axis of revolution takes
    // none.
    for (const GivenSupport& one : supports) {
      if (!one.axis) continue;
      const auto same = std::count_if(supports.begin(), supports.end(), [&](const GivenSupport& other) {
        return other.axis && other.entry < sums.size() &&
               std::abs(dot(other.direction, one.direction)) > Real(0.5L);
      });
      put(one.entry, node, dot(one.direction, all) / larger(Real(same), 1) * one.direction, size);
    }
    if (const auto there = problem.directions.find(node); there != problem.directions.end())
      for (const GivenDirection& one : there->second)
        put(one.entry, node, dot(one.direction, all) * one.direction,
            size + one.condition * (std::numeric_limits<Real>::epsilon() / share_of_terms) * norm(all));
  }
  for (const Spring& spring : problem.each_spring) {
    const Vec& u = answer.u[static_cast<std::size_t>(spring.node)];
    Vec force{};
    Real size = 0;
    for (std::size_t r = 0; r < 3; ++r) {
      force[r] = -dot(spring.stiffness[r], u);
      size += norm(spring.stiffness[r]) * norm(u);
    }
    put(spring.entry, spring.node, force, size);
  }
  return sums;
}

void compare_boundary(const json& document, const json& result, const Problem& problem, const Answer& answer,
                      const BodyResponse& body, std::vector<Difference>& out) {
  const auto supports = reactions(problem, answer, body);
  const bool turns = !problem.mesh.is_round;
  const auto note = [&](const char* list, std::size_t e, const Resultant& sum) {
    const std::string name = name_of_entry(document, "boundary", e);
    Notes notes(entry_of(result, list, name), std::string(list) + "." + name + ".", out);
    const Real share = share_of_terms + elements_of_node * sum.nodes * epsilon_of_doubles / 2;
    notes.vector("force", sum.force, share * sum.size);
    notes.vector("moment", turns ? sum.moment : Vec{}, share * sum.arms);
  };
  for (std::size_t e = 0; e < supports.size(); ++e) {
    if (supports[e]) note("reaction", e, *supports[e]);
    if (problem.applied[e].size > 0) note("load", e, problem.applied[e]);
  }
}

/// Returns the reference coordinates of a point in an element by Newton's method; nothing if it does not
/// converge.
std::optional<Vec> reference_place(const Mesh& mesh, const Indices& element, const Vec& x) {
  const auto dim = static_cast<std::size_t>(mesh.dim());
  const Vec& origin = mesh.nodes[element[0]];
  Vec at{};
  for (int step = 0; step < 60; ++step) {
    if (!(norm(at) < 10)) return std::nullopt;
    const Functions f = functions(mesh.shape, at);
    Vec miss = x - origin;
    std::array<Vec, 3> along{};
    if (dim == 2) along[2] = {0, 0, 1};
    for (std::size_t a = 1; a < element.size(); ++a) {
      const Vec side = mesh.nodes[element[a]] - origin;
      miss = miss - f.value[a] * side;
      for (std::size_t k = 0; k < dim; ++k) along[k] = along[k] + f.gradient[a][k] * side;
    }
    const std::array<Vec, 3> dual{cross(along[1], along[2]), cross(along[2], along[0]),
                                  cross(along[0], along[1])};
    const Real det = dot(along[0], dual[0]);
    Vec move{};
    for (std::size_t k = 0; k < dim; ++k) move[k] = dot(dual[k], miss) / det;
    at = at + move;
    if (norm(move) < 1e-17L) return at;
    if (step > 40 && norm(move) < 1e-14L) return at;
  }
  return std::nullopt;
}

/// Distance of a point from the reference cell; negative inside.
Real outside(Shape shape, const Vec& at) {
  const auto dim = static_cast<std::size_t>(dimension(shape));
  Real most = -1, rest = 1, least = 1;
  for (std::size_t c = 0; c < dim; ++c) {
    most = std::max(most, std::abs(at[c]) - 1);
    least = std::min(least, at[c]);
    rest -= at[c];
  }
  return shape == Shape::quad4 || shape == Shape::hex8 ? most : -std::min(least, rest);
}

/// Returns whether a point lies in the element's bounding box, enlarged by half its size on each side.
bool is_near(const Mesh& mesh, const Indices& element, const Vec& x) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(mesh.dim()); ++c) {
    Real low = HUGE_VALL, high = -HUGE_VALL;
    for (const Index node : element) {
      low = std::min(low, mesh.nodes[node][c]);
      high = std::max(high, mesh.nodes[node][c]);
    }
    const Real margin = (high - low) / 2;
    if (x[c] < low - margin || x[c] > high + margin) return false;
  }
  return true;
}

/// Compares the displacements at the probes.
void compare_probes(const json& result, const Problem& problem, const Answer& answer,
                    std::vector<Difference>& out) {
  const Mesh& mesh = problem.mesh;
  for (std::size_t p = 0; p < problem.probes.size(); ++p) {
    const std::string name = "probe[" + std::to_string(p) + "]";
    if (!result.contains("probe") || result.at("probe").size() <= p)
      throw Failure("result.json: expected " + name);
    Real least = 1e-5L, unknown = 0;
    Vec moved{};
    bool found = false;
    for (const Indices& element : mesh.elements) {
      if (!is_near(mesh, element, problem.probes[p])) continue;
      const std::optional<Vec> at = reference_place(mesh, element, problem.probes[p]);
      if (!at || !(outside(mesh.shape, *at) < least)) continue;
      const Real beyond = larger(outside(mesh.shape, *at), 0);
      least = larger(beyond, 0);
      found = true;
      moved = {};
      Real strained = 0, most = 0;
      const Functions f = functions(mesh.shape, *at);
      for (std::size_t a = 0; a < element.size(); ++a) {
        const Vec& u = answer.u[element[a]];
        moved = moved + f.value[a] * u;
        most = larger(most, norm(u));
        strained = larger(strained, norm(u - answer.u[element[0]]));
      }
      // The program locates the point to 1e-12; just outside the body it may have chosen another element.
      unknown = (1e-11L + 20 * beyond) * strained + 20 * epsilon_of_doubles * most;
      if (beyond == 0) break;
    }
    if (!found) throw Failure("result.json: " + name + ": the point lies in no element of the mesh");
    const json& said = result.at("probe").at(p);
    const json object{{name, said}};
    Notes(object, "", out).vector(name.c_str(), moved, unknown);
  }
}

}  // namespace

std::vector<Difference> differing_totals(const json& document, const json& result, const Problem& problem,
                                         const Answer& answer, const BodyResponse& body) {
  std::vector<Difference> out;
  compare_contact(document, result, problem, answer, out);
  compare_counts(result, problem, answer, out);
  compare_boundary(document, result, problem, answer, body, out);
  compare_probes(result, problem, answer, out);
  Real moved = 0;
  for (const Vec& u : answer.u) moved = larger(moved, norm(u));
  if (result.contains("max_displacement"))
    Notes(result.at("max_displacement"), "max_displacement.", out)
        .number("value", moved, 8 * epsilon_of_doubles * moved);
  return out;
}

}  // namespace kacanov::verify
