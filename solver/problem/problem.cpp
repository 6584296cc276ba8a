// SPDX-License-Identifier: BSD-3-Clause
// Builds a problem from mesh and model step by step, and checks that it can be solved.
#include <kacanov/problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "problem/conditions.hpp"
#include "problem/contact_points.hpp"
#include "problem/input_errors.hpp"
#include "problem/model_checks.hpp"
#include "problem/point_location.hpp"
#include "problem/rigid_modes.hpp"
#include "problem/selection.hpp"
#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {

/// Returns one Probe per point of model.probes. Points outside the body by less than 1e-6 of an element count
/// as on its boundary; for any other outside point throws InputError that names the nearest node.
std::vector<Probe> locate_probes(const Mesh& mesh, const Model& model);

namespace {

/// Tolerance for points outside their element, in reference coordinates.
constexpr double probe_slack = 1e-6;

std::string outside_message(const Mesh& mesh, std::size_t index, const Vector3& x) {
  std::int32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto count = static_cast<std::int32_t>(mesh.node_count());
  for (std::int32_t node = 0; node < count; ++node) {
    const double distance = norm(position(mesh, node) - x);
    if (distance < least) {
      least = distance;
      nearest = node;
    }
  }
  PlainText text;
  text << "probe[" << index << "]: the point " << to_text(x, mesh.dim())
       << " lies outside the body; the nearest node, " << mesh.node_tag(nearest) << " at "
       << to_text(position(mesh, nearest), mesh.dim()) << ", is " << least << " away";
  return text.str();
}

}  // namespace

std::vector<Probe> locate_probes(const Mesh& mesh, const Model& model) {
  std::vector<Probe> probes(model.probes.size());
  std::vector<double> best(model.probes.size(), probe_slack);
  for (std::size_t p = 0; p < probes.size(); ++p) {
    probes[p].point = model.probes[p];
    probes[p].element = -1;
  }
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count() && !probes.empty(); ++e) {
    const auto nodes = std::span(mesh.elements).subspan(e * n, n);
    for (std::size_t p = 0; p < probes.size(); ++p) {
      if (!near_element(mesh.view(), nodes, probes[p].point)) continue;
      const std::optional<Vector3> at = reference_point(mesh.view(), nodes, probes[p].point);
      if (!at) continue;
      const double miss = outside(cell(mesh.type), *at);
      if (miss > best[p] || (probes[p].element >= 0 && miss == best[p])) continue;
      best[p] = miss;
      probes[p].element = static_cast<std::int32_t>(e);
      probes[p].weights = shapes_at(cell(mesh.type), *at).value;
    }
  }
  for (std::size_t p = 0; p < probes.size(); ++p) {
    if (probes[p].element < 0) throw InputError(outside_message(mesh, p, probes[p].point));
  }
  return probes;
}

namespace {

/// Squares of forces and products of four lengths must fit in a double, with the digits of a residual.
void refuse_out_of_range(const std::string& what, double value) {
  constexpr double least = 1e-45, most = 1e45;
  if (!std::isfinite(value) || (value >= least && value <= most)) return;
  PlainText text;
  text << what << " is " << value << ", expected between " << least << " and " << most
       << ", so that double precision holds what follows from it: take other units";
  throw InputError(text.str());
}

const char* name_of(PlaneState plane) {
  return plane == PlaneState::stress         ? "plane stress"
         : plane == PlaneState::axisymmetric ? "an axisymmetric body"
                                             : "plane strain";
}

/// Sets the mesh's plane state from the model; moves nodes next to the axis onto it.
void set_plane(Mesh& mesh, const Model& model) {
  const PlaneState plane = model.plane;
  if (mesh.plane != PlaneState::strain && mesh.plane != plane)
    mesh.warnings.push_back(std::string("plane: the mesh is of elements of ") + name_of(mesh.plane) +
                            ", and is taken as that of " + name_of(plane));
  mesh.plane = plane;
  mesh.thickness = model.thickness;
  if (mesh.thickness != 1.0 && mesh.dim() != 2)
    throw InputError("thickness: expected 1, or a mesh in 2D, got one in 3D");
  if (plane == PlaneState::strain) return;
  if (mesh.dim() != 2) throw InputError("plane: expected \"strain\", or a mesh in 2D, got one in 3D");
  if (plane != PlaneState::axisymmetric) return;
  constexpr double on_axis = 1e-12;
  const double reach = on_axis * extent(mesh).size;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    double& radius = mesh.coordinates[2 * n];
    if (std::abs(radius) <= reach) radius = 0.0;
    if (radius >= 0.0) continue;
    PlainText text;
    text << "plane: node " << mesh.node_tag(n) << " lies at x = " << radius
         << "; an axisymmetric mesh is a section with x ≥ 0, the distance from the axis";
    throw InputError(text.str());
  }
}

}  // namespace

namespace {

/// Collects every `on` that selects nothing, because building the problem stops at the first one.
void note_empty_selections(const Model& model, const Selection& selection, Mistakes& mistakes) {
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    mistakes.in([&] { selection.elements(model.materials[i].on, at("material", i)); });
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    mistakes.in([&] {
      if (entry.body_force || entry.temperature)
        selection.elements(entry.on, at("boundary", i));
      else if (entry.displacement || entry.node_force || entry.node_spring)
        selection.nodes(entry.on, at("boundary", i));
      else
        selection.facets(entry.on, at("boundary", i));
    });
  }
  for (std::size_t i = 0; i < model.contact.size(); ++i)
    mistakes.in([&] { selection.facets(model.contact[i].on, at("contact", i)); });
}

}  // namespace

Problem build_problem(Mesh mesh, const Model& model) {
  validate(model);
  if (!mesh.coordinates.empty()) refuse_out_of_range("mesh: the size of the body", extent(mesh).size);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const Law& law = model.materials[i].law;
    for (const double modulus : {law.bulk, law.secant(0.0)})
      refuse_out_of_range("material[" + std::to_string(i) + "]: a modulus", modulus);
  }
  check_mesh(mesh);
  Problem problem;
  problem.mesh = std::move(mesh);
  set_plane(problem.mesh, model);
  const std::size_t unknowns = problem.mesh.coordinates.size();
  problem.load.assign(unknowns, 0.0);
  problem.held.assign(unknowns, 0);
  problem.prescribed.assign(unknowns, 0.0);

  const Selection selection(problem.mesh);
  try {
    assign_materials(problem, model, selection);
    assemble_load(problem, model, selection);
    hold_displacements(problem, model, selection);
    add_springs(problem, model, selection);
    find_contact_points(problem, model, selection);
  } catch (const InputError& first) {
    Mistakes mistakes;
    mistakes.note(first.what());
    note_empty_selections(model, selection, mistakes);
    mistakes.raise();
  }
  check_rigid_modes(problem);
  problem.probes = locate_probes(problem.mesh, model);
  return problem;
}

std::span<const HeldDirection> directions_of(std::span<const HeldDirection> all, std::int32_t node) {
  const auto first = std::lower_bound(all.begin(), all.end(), node,
                                      [](const HeldDirection& d, std::int32_t n) { return d.node < n; });
  auto last = first;
  while (last != all.end() && last->node == node) ++last;
  return {first, last};
}

Vector3 project_out(std::span<const HeldDirection> directions, Vector3 v) {
  for (const HeldDirection& held : directions) v = v - dot(held.direction, v) * held.direction;
  return v;
}

std::vector<std::int32_t> keep_boundary(Problem& problem) {
  const auto free = [](auto& array) { std::remove_reference_t<decltype(array)>().swap(array); };
  free(problem.law_of_element);
  free(problem.load);
  free(problem.held);
  free(problem.prescribed);
  free(problem.forces);
  free(problem.holder);
  free(problem.supports);
  free(problem.directions);
  free(problem.springs);
  free(problem.thermal);
  Mesh& mesh = problem.mesh;
  free(mesh.node_fields);
  std::vector<std::int32_t> left;
  if (mesh.dim() == 2) {
    left.resize(mesh.node_count());
    std::iota(left.begin(), left.end(), 0);
    return left;
  }
  left = mesh.facets;
  std::sort(left.begin(), left.end());
  left.erase(std::unique(left.begin(), left.end()), left.end());
  left.shrink_to_fit();
  const auto renumber = [&left](std::int32_t& node) {
    node = static_cast<std::int32_t>(std::lower_bound(left.begin(), left.end(), node) - left.begin());
  };
  std::vector<double> coordinates;
  std::vector<std::int64_t> tags;
  coordinates.reserve(3 * left.size());
  tags.reserve(left.size());
  for (const std::int32_t old : left) {
    const std::size_t n = old;
    coordinates.insert(coordinates.end(), mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(3 * n),
                       mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(3 * n + 3));
    tags.push_back(mesh.node_tag(n));
  }
  mesh.coordinates.swap(coordinates);
  mesh.node_tags.swap(tags);
  std::for_each(mesh.facets.begin(), mesh.facets.end(), renumber);
  problem.contact.renumber(renumber);
  free(mesh.elements);
  free(mesh.element_tags);
  free(mesh.facet_element);
  std::erase_if(mesh.groups, [](const Group& group) { return group.dimension != 2; });
  return left;
}

}  // namespace kacanov
