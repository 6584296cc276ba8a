// SPDX-License-Identifier: BSD-3-Clause
// Materials, loads and given displacements: the entries of a model carried over to a mesh.
#include "problem/conditions.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>

#include <kacanov/error.hpp>
#include "problem/integration.hpp"
#include "problem/load_curves.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

std::string path_of(const char* list, std::size_t index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

void add(std::vector<double>& load, int dim, std::int32_t node, const Vector3& force) {
  for (int c = 0; c < dim; ++c) {
    load[static_cast<std::size_t>(node) * static_cast<std::size_t>(dim) + static_cast<std::size_t>(c)] +=
        force[c];
  }
}

void add_facet_loads(Problem& problem, const BoundaryEntry& entry, std::span<const std::int32_t> facets) {
  const Mesh& mesh = problem.mesh;
  for (const std::int32_t f : facets) {
    const FacetWeights weights = consistent_weights(mesh, f);
    const auto nodes = mesh.facet(f);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (entry.traction) add(problem.load, mesh.dim(), nodes[k], weights.area[k] * *entry.traction);
      if (entry.pressure) add(problem.load, mesh.dim(), nodes[k], -*entry.pressure * weights.normal[k]);
    }
  }
}

void add_body_force(Problem& problem, const Vector3& force, std::span<const std::int32_t> elements) {
  const Mesh& mesh = problem.mesh;
  const std::size_t n = nodes_per_element(mesh.type);
  for (const std::int32_t e : elements) {
    const auto weights = volume_weights(mesh, e);
    for (std::size_t k = 0; k < n; ++k) {
      add(problem.load, mesh.dim(), mesh.elements[static_cast<std::size_t>(e) * n + k], weights[k] * force);
    }
  }
}

}  // namespace

void assign_materials(Problem& problem, const Model& model, const Selection& selection) {
  constexpr std::uint16_t none = std::numeric_limits<std::uint16_t>::max();
  const Mesh& mesh = problem.mesh;
  problem.law_of_element.assign(mesh.element_count(), none);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const std::string path = path_of("material", i);
    const MaterialEntry& entry = model.materials[i];
    if (entry.law.mean_dilatation && !cell(mesh.type).mean_dilatation)
      throw InputError(path + ".bbar: expected false, or a mesh of " + bbar_names() +
                       ": other elements have no B-bar here");
    problem.laws.push_back(entry.law);
    for (const std::int32_t e : selection.elements(entry.on, path)) {
      std::uint16_t& law = problem.law_of_element[e];
      if (law != none && model.materials[law].on.kind != Selector::Kind::all) {
        throw InputError(path + ".on: element " + std::to_string(mesh.element_tag(e)) +
                         " already has the material of " + path_of("material", law) +
                         " (only an entry on \"all\" may be overridden)");
      }
      law = static_cast<std::uint16_t>(i);
    }
  }
  std::size_t bare = 0, first = 0;
  for (std::size_t e = mesh.element_count(); e-- > 0;) {
    if (problem.law_of_element[e] != none) continue;
    ++bare;
    first = e;
  }
  if (bare > 0) {
    throw InputError("material: element " + std::to_string(mesh.element_tag(first)) + " has no material (" +
                     std::to_string(bare) + " of " + std::to_string(mesh.element_count()) +
                     " elements have none)");
  }
}

namespace {

/// Moves what an entry has put on problem.load over to the forces entry by entry.
void keep_apart(Problem& problem, std::size_t entry) {
  for (std::size_t k = 0; k < problem.load.size(); ++k) {
    if (problem.load[k] == 0.0) continue;
    problem.forces.push_back(
        {static_cast<std::int32_t>(k), static_cast<std::int32_t>(entry), problem.load[k]});
    problem.load[k] = 0.0;
  }
}

}  // namespace

void assemble_load(Problem& problem, const Model& model, const Selection& selection) {
  problem.steps = load_curves(model);
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    const std::string path = path_of("boundary", i);
    if (entry.traction || entry.pressure) add_facet_loads(problem, entry, selection.facets(entry.on, path));
    if (entry.body_force) add_body_force(problem, *entry.body_force, selection.elements(entry.on, path));
    if (!problem.steps.empty()) keep_apart(problem, i);
  }
  if (problem.steps.empty()) return;
  std::stable_sort(problem.forces.begin(), problem.forces.end(),
                   [](const EntryForce& a, const EntryForce& b) { return a.component < b.component; });
  problem.load = load_at(problem, 1);
}

std::vector<double> load_at(const Problem& problem, std::size_t step) {
  std::vector<double> load(problem.mesh.coordinates.size(), 0.0);
  for (const EntryForce& force : problem.forces)
    load[force.component] += problem.steps[step].boundary[force.entry] * force.value;
  return load;
}

void hold_displacements(Problem& problem, const Model& model, const Selection& selection) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  std::vector<std::int32_t> holder(problem.held.size(), -1);
  const auto refuse = [&](std::size_t entry, std::size_t k, const std::string& why) {
    const std::size_t node = k / dim;
    throw InputError(path_of("boundary", entry) + ".displacement: node " +
                     std::to_string(mesh.node_tag(node)) + " at " +
                     to_text(position(mesh, static_cast<std::int32_t>(node)), mesh.dim()) + " is given " +
                     why + path_of("boundary", static_cast<std::size_t>(holder[k])));
  };
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    if (!entry.displacement) continue;
    const std::string path = path_of("boundary", i);
    for (const std::int32_t node : selection.nodes(entry.on, path)) {
      for (std::size_t c = 0; c < dim; ++c) {
        const std::optional<double>& value = (*entry.displacement)[c];
        if (!value) continue;
        const std::size_t k = static_cast<std::size_t>(node) * dim + c;
        if (problem.held[k] != 0 && problem.prescribed[k] != *value) {
          std::ostringstream text;
          text << "xyz"[c] << " = " << *value << " here and " << problem.prescribed[k] << " by ";
          refuse(i, k, text.str());
        }
        if (problem.held[k] != 0 && *value != 0.0 && !problem.steps.empty() &&
            !same_course(problem.steps, i, static_cast<std::size_t>(holder[k])))
          refuse(i, k, std::string(1, "xyz"[c]) + " here with other factors in steps than by ");
        problem.held[k] = 1;
        problem.prescribed[k] = *value;
        holder[k] = static_cast<std::int32_t>(i);
      }
    }
  }
  if (!problem.steps.empty()) problem.holder = std::move(holder);
}

}  // namespace kacanov
