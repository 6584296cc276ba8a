// SPDX-License-Identifier: BSD-3-Clause
// Resolves the `on` selectors of a model on a mesh.
#include "problem/selection.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "problem/input_errors.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

std::vector<std::int32_t> all_of(std::size_t count) {
  std::vector<std::int32_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

void sort_unique(std::vector<std::int32_t>& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

std::string kind_of(int group_dimension, int dim) {
  if (group_dimension == dim) return "elements";
  return group_dimension == dim - 1 ? "boundary facets" : "nodes";
}

}  // namespace

std::string to_text(const Vector3& v, int dim) {
  PlainText text;
  text << '(' << v[0] << ", " << v[1];
  if (dim == 3) text << ", " << v[2];
  text << ')';
  return text.str();
}

Extent extent(const Mesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Extent box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, 0.0};
  const auto count = static_cast<std::int32_t>(mesh.node_count());
  for (std::int32_t node = 0; node < count; ++node) {
    const Vector3 x = position(mesh, node);
    for (std::size_t c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], x[c]);
      box.upper[c] = std::max(box.upper[c], x[c]);
    }
  }
  box.size = norm(box.upper - box.lower);
  return box;
}

std::vector<std::int32_t> nodes_of_facets(const Mesh& mesh, std::span<const std::int32_t> facets) {
  std::vector<std::int32_t> nodes;
  nodes.reserve(facets.size() * static_cast<std::size_t>(nodes_per_facet(mesh.type)));
  for (const std::int32_t f : facets) {
    const auto facet = mesh.facet(f);
    nodes.insert(nodes.end(), facet.begin(), facet.end());
  }
  sort_unique(nodes);
  return nodes;
}

Selection::Selection(const Mesh& mesh) : mesh_(mesh), extent_(extent(mesh)) {}

std::vector<const Group*> Selection::named(const Selector& on, const std::string& path, int lowest,
                                           int highest, const std::string& wanted) const {
  std::vector<const Group*> found;
  std::string other_kind;
  for (const Group& group : mesh_.groups) {
    if (group.name != on.name) continue;
    if (group.dimension >= lowest && group.dimension <= highest) {
      found.push_back(&group);
    } else {
      other_kind = kind_of(group.dimension, mesh_.dim());
    }
  }
  if (!found.empty()) return found;
  if (!other_kind.empty()) {
    throw InputError(path + ".on: the part \"" + on.name + "\" is made of " + other_kind + ", expected " +
                     wanted);
  }
  std::vector<std::string> names;
  for (const Group& group : mesh_.groups) names.push_back(group.name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::string message = path + ".on: no part is called \"" + on.name + "\"";
  const std::string guess = closest_word(on.name, names);
  if (!guess.empty()) message += " (did you mean \"" + guess + "\"?)";
  message += names.empty() ? "; the mesh has no named parts" : "; there are: all";
  for (const std::string& name : names) message += ", " + name;
  throw InputError(message);
}

std::vector<std::int32_t> Selection::in_box(const Selector& on, const std::string& path,
                                            std::span<const std::int32_t> cells, int nodes_per_cell,
                                            const std::string& wanted) const {
  const double slack = 1e-9 * extent_.size;
  const std::size_t dim = mesh_.dim();
  std::vector<std::uint8_t> inside(mesh_.node_count());
  for (std::size_t node = 0; node < inside.size(); ++node) {
    const Vector3 x = position(mesh_, static_cast<std::int32_t>(node));
    bool within = true;
    for (std::size_t c = 0; c < dim; ++c) {
      within = within && x[c] >= on.lower[c] - slack && x[c] <= on.upper[c] + slack;
    }
    inside[node] = within ? 1 : 0;
  }
  std::vector<std::int32_t> chosen;
  const std::size_t n = nodes_per_cell;
  for (std::size_t cell = 0; cell < cells.size() / n; ++cell) {
    const auto nodes = cells.subspan(cell * n, n);
    if (std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t node) { return inside[node] != 0; })) {
      chosen.push_back(static_cast<std::int32_t>(cell));
    }
  }
  if (chosen.empty()) {
    throw InputError(path + ".on: the box from " + to_text(on.lower, mesh_.dim()) + " to " +
                     to_text(on.upper, mesh_.dim()) + " holds no " + wanted +
                     " (one counts when all its nodes lie in the box); the mesh reaches from " +
                     to_text(extent_.lower, mesh_.dim()) + " to " + to_text(extent_.upper, mesh_.dim()));
  }
  return chosen;
}

std::vector<std::int32_t> Selection::facets(const Selector& on, const std::string& path) const {
  if (on.kind == Selector::Kind::all) return all_of(mesh_.facet_count());
  if (on.kind == Selector::Kind::box) {
    return in_box(on, path, mesh_.facets, nodes_per_facet(mesh_.type), "boundary facet");
  }
  std::vector<std::int32_t> chosen;
  for (const Group* group : named(on, path, mesh_.dim() - 1, mesh_.dim() - 1, "boundary facets")) {
    chosen.insert(chosen.end(), group->members.begin(), group->members.end());
  }
  sort_unique(chosen);
  if (chosen.empty()) {
    throw InputError(path + ".on: the part \"" + on.name + "\" has no facet on the boundary of the body");
  }
  return chosen;
}

std::vector<std::int32_t> Selection::elements(const Selector& on, const std::string& path) const {
  if (on.kind == Selector::Kind::all) return all_of(mesh_.element_count());
  if (on.kind == Selector::Kind::box) {
    return in_box(on, path, mesh_.elements, nodes_per_element(mesh_.type), "element");
  }
  std::vector<std::int32_t> chosen;
  for (const Group* group : named(on, path, mesh_.dim(), mesh_.dim(), "elements")) {
    chosen.insert(chosen.end(), group->members.begin(), group->members.end());
  }
  sort_unique(chosen);
  if (chosen.empty()) throw InputError(path + ".on: the part \"" + on.name + "\" has no element");
  return chosen;
}

std::vector<std::int32_t> Selection::nodes(const Selector& on, const std::string& path) const {
  if (on.kind != Selector::Kind::name) return nodes_of_facets(mesh_, facets(on, path));
  std::vector<std::int32_t> chosen;
  for (const Group* group : named(on, path, 0, mesh_.dim() - 1, "boundary facets or nodes")) {
    if (group->dimension == mesh_.dim() - 1) {
      const std::vector<std::int32_t> nodes = nodes_of_facets(mesh_, group->members);
      chosen.insert(chosen.end(), nodes.begin(), nodes.end());
    } else {
      chosen.insert(chosen.end(), group->members.begin(), group->members.end());
    }
  }
  sort_unique(chosen);
  if (chosen.empty()) {
    throw InputError(path + ".on: the part \"" + on.name + "\" has no facet on the boundary of the body");
  }
  return chosen;
}

}  // namespace kacanov
