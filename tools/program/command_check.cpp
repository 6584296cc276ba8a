// SPDX-License-Identifier: BSD-3-Clause
// kacanov check: validates a case, prints its selections and estimates its cost.
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "formats/printable.hpp"
#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "program/commands.hpp"
#include "program/loaded_case.hpp"
#include "program/memory_model.hpp"
#include "program/report.hpp"

namespace kacanov {
namespace {

std::string on_text(const Selector& on, int dim) {
  if (on.kind == Selector::Kind::all) return "all";
  if (on.kind == Selector::Kind::name) return "\"" + printable(on.name) + "\"";
  return "box " + to_text(on.lower, dim) + " to " + to_text(on.upper, dim);
}

void print_entry(const std::string& path, const std::string& what, const std::string& on,
                 const std::string& found) {
  std::printf("  %-14s %-14s on %s: %s\n", path.c_str(), what.c_str(), on.c_str(), found.c_str());
}

std::string path_of(const char* list, std::size_t index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

std::string facets_text(const Mesh& mesh, std::span<const std::int32_t> facets) {
  double area = 0.0;
  for (const std::int32_t f : facets) {
    for (const double w : consistent_weights(mesh, f).area) area += w;
  }
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%zu facets, %s %.6g", facets.size(),
                mesh.dim() == 2 && mesh.plane != PlaneState::axisymmetric ? "length" : "area", area);
  return text.data();
}

void print_selections(const Problem& problem, const Model& model) {
  const Mesh& mesh = problem.mesh;
  const Selection selection(mesh);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const auto mine = std::count(problem.law_of_element.begin(), problem.law_of_element.end(), i);
    print_entry(path_of("material", i), "", on_text(model.materials[i].on, mesh.dim()),
                std::to_string(mine) + " elements");
  }
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    const std::string path = path_of("boundary", i), on = on_text(entry.on, mesh.dim());
    if (entry.is_support()) {
      print_entry(path, entry.normal ? "normal" : "displacement", on,
                  std::to_string(selection.nodes(entry.on, path).size()) + " nodes");
    } else if (entry.node_spring || entry.node_force) {
      print_entry(path, entry.node_force ? "node_force" : "node_spring", on,
                  std::to_string(selection.nodes(entry.on, path).size()) + " nodes");
    } else if (entry.body_force || entry.temperature) {
      print_entry(path, entry.temperature ? "temperature" : "body_force", on,
                  std::to_string(selection.elements(entry.on, path).size()) + " elements");
    } else {
      const char* kind = entry.is_spring()   ? "spring"
                         : entry.traction    ? "traction"
                         : entry.total_force ? "total_force"
                                             : "pressure";
      print_entry(path, kind, on, facets_text(mesh, selection.facets(entry.on, path)));
    }
  }
  for (std::size_t i = 0; i < model.contact.size(); ++i) {
    const std::string path = path_of("contact", i);
    const auto points =
        std::count_if(problem.contact.begin(), problem.contact.end(),
                      [i](const ContactPoint& p) { return p.entry == static_cast<std::int32_t>(i); });
    print_entry(path, "contact", on_text(model.contact[i].on, mesh.dim()),
                facets_text(mesh, selection.facets(model.contact[i].on, path)) + ", " +
                    std::to_string(points) + " contact points");
  }
}

void print_range(const char* name, double low, double high) {
  std::printf("  %-14s %.6g to %.6g\n", name, low, high);
}

void print_contact_gaps(const Problem& problem) {
  if (problem.contact.empty()) return;
  const auto [low, high] = std::minmax_element(problem.contact.begin(), problem.contact.end(),
                                               [](const auto& a, const auto& b) { return a.gap < b.gap; });
  print_range("initial gap", low->gap, high->gap);
}

// Rough time model, fitted to runs of the beam in 2D and 3D: core seconds per unknown. The case matters more.
constexpr double seconds_elastic = 1e-5, seconds_plastic = 2.5e-5;

void print_estimate(const Problem& problem, const Case& input, int ranks) {
  const auto unknowns = static_cast<double>(problem.mesh.coordinates.size());
  ProblemSize size = size_of(problem.mesh, input.model);
  size.contact_points = static_cast<double>(problem.contact.size());
  const double seconds = unknowns * (size.nonlinear ? seconds_plastic : seconds_elastic) / ranks;
  std::string memory = readable_bytes(estimated_memory(size, ranks)) + " of memory";
  if (size.may_flow)
    memory += " (" + readable_bytes(estimated_memory(flowing(size), ranks)) + " where k0/g gets beyond 300)";
  std::printf(
      "  estimate       %s, %s on %d %s (time within a factor of three for a usual case); available: %s\n",
      memory.c_str(), readable_seconds(std::max(seconds, 0.05)).c_str(), ranks, ranks == 1 ? "rank" : "ranks",
      readable_bytes(available_memory()).c_str());
}

}  // namespace

int check_command(const Case& input, int ranks) {
  const Problem problem = load_problem(input, {ranks, ranks});
  print_warnings(input, problem);
  const Mesh& mesh = problem.mesh;
  const int dim = mesh.dim();
  const Extent box = extent(mesh);
  std::printf("%s: the case is valid\n", input.name.c_str());
  std::printf("  mesh           %zu %s elements, %zu nodes, %zu unknowns, %zu boundary facets\n",
              mesh.element_count(), std::string(cell(mesh.type).name).c_str(), mesh.node_count(),
              mesh.coordinates.size(), mesh.facet_count());
  std::printf("  extent         %s to %s\n", to_text(box.lower, dim).c_str(),
              to_text(box.upper, dim).c_str());
  for (const Group& group : mesh.groups) {
    const char* kind = group.dimension == dim       ? "elements"
                       : group.dimension == dim - 1 ? "boundary facets"
                                                    : "nodes";
    std::printf("  part           \"%s\": %zu %s\n", group.name.c_str(), group.members.size(), kind);
  }
  print_selections(problem, input.model);
  print_contact_gaps(problem);
  for (std::size_t i = 0; i < problem.probes.size(); ++i) {
    const std::size_t element = problem.probes[i].element;
    std::printf("  %-14s %s in element %lld\n", path_of("probe", i).c_str(),
                to_text(problem.probes[i].point, dim).c_str(),
                static_cast<long long>(mesh.element_tag(element)));
  }
  if (!input.preset.name.empty())
    std::printf("  %-14s %s\n", "preset", printable(input.preset.text()).c_str());
  print_estimate(problem, input, ranks);
  std::fflush(stdout);
  return exit_converged;
}

}  // namespace kacanov
