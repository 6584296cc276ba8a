// SPDX-License-Identifier: BSD-3-Clause
// Resolves materials, loads and prescribed displacements of a model on a mesh.
#include "problem/conditions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <kacanov/error.hpp>
#include "law/plane_stress.hpp"
#include "problem/integration.hpp"
#include "problem/load_curves.hpp"
#include "problem/model_checks.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Adds the forces of one entry to the nodes, and accumulates their resultant.
class LoadOfEntry {
 public:
  LoadOfEntry(Problem& problem, std::size_t entry) : problem_(problem) {
    applied_.entry = static_cast<std::int32_t>(entry);
  }

  void add(std::int32_t node, const Vector3& force) {
    const std::size_t dim = problem_.mesh.dim();
    Vector3 here{};
    for (std::size_t c = 0; c < dim; ++c) {
      here[c] = force[c];
      problem_.load[node * dim + c] += force[c];
    }
    Resultant& total = applied_.total;
    total.force = total.force + here;
    total.moment = total.moment + cross(position(problem_.mesh, node), here);
  }
  void finish() const { problem_.applied.push_back(applied_); }

 private:
  Problem& problem_;
  AppliedLoad applied_;
};

void add_pressure(const Mesh& mesh, double pressure, std::span<const std::int32_t> facets,
                  LoadOfEntry& load) {
  for (const std::int32_t f : facets) {
    const FacetWeights weights = consistent_weights(mesh, f);
    const auto nodes = mesh.facet(f);
    for (std::size_t k = 0; k < nodes.size(); ++k) load.add(nodes[k], -pressure * weights.normal[k]);
  }
}

void add_traction(const Mesh& mesh, const Vector3& traction, std::span<const std::int32_t> facets,
                  LoadOfEntry& load) {
  for (const std::int32_t f : facets) {
    const FacetWeights weights = consistent_weights(mesh, f);
    const auto nodes = mesh.facet(f);
    for (std::size_t k = 0; k < nodes.size(); ++k) load.add(nodes[k], weights.area[k] * traction);
  }
}

double area_of(const Mesh& mesh, std::span<const std::int32_t> facets) {
  double area = 0.0;
  for (const std::int32_t f : facets)
    for (const double weight : consistent_weights(mesh, f).area) area += weight;
  return area;
}

void add_body_force(const Mesh& mesh, const Vector3& force, std::span<const std::int32_t> elements,
                    LoadOfEntry& load) {
  const std::size_t n = nodes_per_element(mesh.type);
  for (const std::int32_t e : elements) {
    const auto weights = volume_weights(mesh, e);
    for (std::size_t k = 0; k < n; ++k) load.add(mesh.elements[e * n + k], weights[k] * force);
  }
}

/// Temperature rise at each corner of an element.
class CornerRise {
 public:
  CornerRise(const Mesh& mesh, const Temperature& rise, const std::string& path)
      : mesh_(mesh), rise_(rise), path_(path) {
    if (rise.nodes.empty()) return;
    const auto found = std::find_if(mesh.node_fields.begin(), mesh.node_fields.end(),
                                    [&](const NodeField& field) { return field.name == rise.nodes; });
    if (found == mesh.node_fields.end())
      throw InputError(path + ": the mesh has no numbers at nodes of the name \"" + rise.nodes + "\"");
    field_ = &*found;
  }

  std::span<const double> of(std::size_t element) {
    const Cell& type = cell(mesh_.type);
    const std::size_t nodes = type.nodes, corners = type.corners;
    for (std::size_t k = 0; k < corners; ++k) here_[k] = at_node(mesh_.elements[element * nodes + k]);
    return std::span(here_).first(corners);
  }

 private:
  double at_node(std::int32_t node) const {
    if (field_ == nullptr) return rise_.value + dot(rise_.gradient, position(mesh_, node) - rise_.point);
    const double value = field_->values[node];
    if (std::isnan(value))
      throw InputError(path_ + ": there is no value for node " + std::to_string(mesh_.node_tag(node)) +
                       ", a corner of elements that the entry selects");
    return value;
  }

  const Mesh& mesh_;
  const Temperature& rise_;
  const std::string& path_;
  const NodeField* field_ = nullptr;
  std::array<double, most_nodes> here_{};
};

/// Adds the nodal forces of fully constrained thermal expansion.
void add_temperature(Problem& problem, const Model& model, const Temperature& rise,
                     std::span<const std::int32_t> elements, LoadOfEntry& load, const std::string& path) {
  const Mesh& mesh = problem.mesh;
  const Cell& type = cell(mesh.type);
  // Strains of linear elements cannot follow a temperature gradient inside them, so only their mean counts.
  const bool differs = !rise.uniform() && type.order > 1;
  const std::size_t n = type.nodes, corners = type.corners, width = differs ? 1 + corners : 1;
  CornerRise corner_rise(mesh, rise, path);
  ThermalPressure& thermal = problem.thermal.back();
  thermal.of_element.assign(width * mesh.element_count(), 0.0);
  for (const std::int32_t e : elements) {
    const std::size_t law = problem.law_of_element[e];
    const double stiffness = model.materials[law].expansion * (mesh.plane == PlaneState::stress
                                                                   ? plane_stress_expansion(problem.laws[law])
                                                                   : 3.0 * problem.laws[law].bulk);
    if (stiffness == 0.0) continue;
    const auto pressure = std::span(thermal.of_element).subspan(width * e, width);
    const auto warmer = rise.uniform() ? std::span<const double>() : corner_rise.of(e);
    pressure[0] = stiffness * (warmer.empty() ? rise.value : mean_by_points(mesh, e, warmer));
    for (std::size_t k = 1; k < width; ++k) pressure[k] = stiffness * warmer[k - 1];
    const auto weights = gradient_weights(mesh, e, pressure.subspan(1));
    for (std::size_t k = 0; k < n; ++k)
      load.add(mesh.elements[e * n + k], (differs ? 1.0 : pressure[0]) * weights[k]);
  }
}

}  // namespace

namespace {

/// Throws InputError if a formulation does not fit the element type or contradicts `bbar`.
void check_formulation(const MaterialEntry& entry, const Mesh& mesh, const std::string& path) {
  if (!entry.formulation) return;
  const bool mixed = entry.formulation == MaterialEntry::Formulation::mixed;
  if (entry.bbar && *entry.bbar != mixed)
    throw InputError(path + ".formulation: " + (mixed ? "mixed is with" : "displacement is without") +
                     " bbar, which is " + (mixed ? "false" : "true"));
  const auto has_mean = [](const Cell& c) { return c.mean_dilatation || c.corner_dilatation; };
  if (mixed && !has_mean(cell(mesh.type)))
    throw InputError(path + ".formulation: expected displacement, or a mesh of " + element_names(has_mean));
  if (mixed && mesh.plane == PlaneState::stress)
    throw InputError(path + ".formulation: expected displacement with plane stress, which does not lock");
}

}  // namespace

bool locks_without_bbar(const Law& law, ElementType type) {
  // Recomputed from the moduli, ν has an error in its last digits that depends on the units.
  constexpr double nearly_incompressible = 0.45 * (1.0 + 1e-12);
  const double poisson = (3.0 * law.bulk - 2.0 * law.shear) / (2.0 * (3.0 * law.bulk + law.shear));
  return cell(type).mean_dilatation && (!law.linear() || poisson > nearly_incompressible);
}

void assign_materials(Problem& problem, const Model& model, const Selection& selection) {
  constexpr std::uint16_t none = std::numeric_limits<std::uint16_t>::max();
  const Mesh& mesh = problem.mesh;
  problem.law_of_element.assign(mesh.element_count(), none);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const std::string path = at("material", i);
    const MaterialEntry& entry = model.materials[i];
    Law law = entry.law;
    check_formulation(entry, mesh, path);
    law.mean_dilatation =
        entry.bbar.value_or(mesh.plane != PlaneState::stress &&
                            (entry.law.mean_dilatation || locks_without_bbar(entry.law, mesh.type)));
    if (entry.formulation) law.mean_dilatation = entry.formulation == MaterialEntry::Formulation::mixed;
    if (law.mean_dilatation && mesh.plane == PlaneState::stress)
      throw InputError(path + ".bbar: expected false with plane stress, which does not lock");
    if (law.mean_dilatation && !cell(mesh.type).mean_dilatation && !entry.formulation)
      throw InputError(path + ".bbar: expected false, or a mesh of " + bbar_names() +
                       ": other elements have no B-bar here");
    problem.laws.push_back(law);
    for (const std::int32_t e : selection.elements(entry.on, path)) {
      std::uint16_t& there = problem.law_of_element[e];
      if (there != none && model.materials[there].on.kind != Selector::Kind::all) {
        throw InputError(path + ".on: element " + std::to_string(mesh.element_tag(e)) +
                         " already has the material of " + at("material", there) +
                         " (only an entry on \"all\" may be overridden)");
      }
      there = static_cast<std::uint16_t>(i);
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

/// Moves the forces of an entry from problem.load to the list of forces per entry.
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
    if (entry.is_support() || entry.is_spring()) continue;
    const std::string path = at("boundary", i);
    const Mesh& mesh = problem.mesh;
    LoadOfEntry load(problem, i);
    if (entry.body_force) {
      add_body_force(mesh, *entry.body_force, selection.elements(entry.on, path), load);
    } else if (entry.node_force) {
      for (const std::int32_t node : selection.nodes(entry.on, path))
        load.add(node, 1.0 / mesh.thickness * *entry.node_force);
    } else if (entry.temperature) {
      const std::vector<std::int32_t> elements = selection.elements(entry.on, path);
      if (std::none_of(elements.begin(), elements.end(), [&](std::int32_t e) {
            return model.materials[problem.law_of_element[e]].expansion != 0.0;
          }))
        throw InputError(path + ".temperature: expected elements whose material has an expansion");
      problem.thermal.push_back({static_cast<std::int32_t>(i), {}});
      add_temperature(problem, model, *entry.temperature, elements, load, path + ".temperature");
    } else {
      const std::vector<std::int32_t> facets = selection.facets(entry.on, path);
      if (entry.traction) add_traction(mesh, *entry.traction, facets, load);
      if (entry.total_force)
        add_traction(mesh, (1.0 / (mesh.thickness * area_of(mesh, facets))) * *entry.total_force, facets,
                     load);
      if (entry.pressure) add_pressure(mesh, *entry.pressure, facets, load);
    }
    load.finish();
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

void add_springs(Problem& problem, const Model& model, const Selection& selection) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    if (!entry.is_spring()) continue;
    const std::string path = at("boundary", i);
    std::map<std::int32_t, std::array<Vector3, 3>> nodes;
    const auto facets = entry.node_spring ? std::vector<std::int32_t>() : selection.facets(entry.on, path);
    const auto add_axes = [&](std::int32_t node, double weight, const Vector3& stiffness) {
      auto& block = nodes[node];
      for (std::size_t c = 0; c < dim; ++c) block[c][c] += weight * stiffness[c];
    };
    if (entry.node_spring)
      for (const std::int32_t node : selection.nodes(entry.on, path))
        add_axes(node, 1.0 / mesh.thickness, *entry.node_spring);
    else
      for (const std::int32_t f : facets) {
        const FacetWeights weights = lumped_weights(mesh, f);
        const auto facet = mesh.facet(f);
        for (std::size_t k = 0; k < facet.size(); ++k) {
          if (weights.area[k] == 0.0) continue;
          if (entry.spring) {
            add_axes(facet[k], weights.area[k], *entry.spring);
            continue;
          }
          auto& block = nodes[facet[k]];
          const Vector3& n = weights.normal[k];
          const double scale = *entry.normal_spring * weights.area[k] / dot(n, n);
          for (std::size_t r = 0; r < 3; ++r) block[r] = block[r] + (scale * n[r]) * n;
        }
      }
    if (nodes.empty() && !facets.empty()) nodes[mesh.facet(facets[0])[0]];  // on the axis; its reaction is 0
    for (const auto& [node, stiffness] : nodes)
      problem.springs.push_back({node, static_cast<std::int32_t>(i), stiffness});
  }
  std::stable_sort(problem.springs.begin(), problem.springs.end(),
                   [](const NodeSpring& a, const NodeSpring& b) { return a.node < b.node; });
}

}  // namespace kacanov
