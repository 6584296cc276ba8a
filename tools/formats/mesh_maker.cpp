// SPDX-License-Identifier: BSD-3-Clause
// Converts file content to a mesh: selects the elements of the body and resolves its groups.
#include "formats/mesh_maker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <kacanov/error.hpp>

namespace kacanov {

void ElementList::assign_last(std::size_t set) {
  const std::size_t last = count() - 1;
  if (!runs.empty() && runs.back().first == last) runs.pop_back();
  if (runs.empty() || runs.back().set != set) runs.push_back({last, set});
}

namespace {

int dimension_of(std::size_t type) { return cells()[type].dim; }

/// Lists the element types for bodies of the dimension.
std::string bodies_of(int dimension) {
  return element_names(dimension == 2 ? [](const Cell& c) { return c.dim == 2; }
                                      : [](const Cell& c) { return c.dim == 3; });
}

/// Returns the only element type of the body as an index into cells().
std::size_t body_cell(const std::string& path, const MeshContent& content) {
  std::vector<std::size_t> top;
  for (std::size_t c = 0; c < cells().size(); ++c) {
    if (content.elements[c].count() == 0) continue;
    if (!top.empty() && dimension_of(c) > dimension_of(top[0])) top.clear();
    if (top.empty() || dimension_of(c) == dimension_of(top[0])) top.push_back(c);
  }
  if (top.empty() || dimension_of(top[0]) < 2)
    throw InputError(path + ": the mesh has nothing that a body can be made of: " +
                     element_names([](const Cell&) { return true; }));
  for (const std::size_t c : top) {
    const Cell& type = cells()[c];
    const std::string element =
        path + ": element " + std::to_string(content.elements[c].tags[0]) + " is a " + std::string(type.name);
    if (!element_type(type))
      throw InputError(element + ": a body in " + std::to_string(type.dim) + "D has to be made of " +
                       bodies_of(type.dim));
    if (c != top[0])
      throw InputError(element + ", but the mesh has elements of type " + std::string(cells()[top[0]].name) +
                       " too: a body has to be made of one type");
  }
  return top[0];
}

/// Drops nodes that no element of the body uses, with a warning: points of the geometry, rests of other
/// bodies. References to them become −1.
void drop_unused_nodes(const std::string& path, MeshContent& content, Mesh& mesh) {
  const std::size_t nodes = content.node_tags.size();
  std::vector<std::int32_t> place(nodes, -1);
  for (const std::int32_t node : mesh.elements) place[node] = 0;
  const auto unused = std::count(place.begin(), place.end(), -1);
  if (unused == 0) return;
  const std::size_t first = std::find(place.begin(), place.end(), -1) - place.begin();
  mesh.warnings.push_back(path + ": " + std::to_string(unused) +
                          (unused == 1 ? " node belongs" : " nodes belong") +
                          " to no element of the body and are left out, the first node " +
                          std::to_string(content.node_tags[first]));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<std::int32_t>(kept);
    content.node_tags[kept] = content.node_tags[i];
    for (std::size_t c = 0; c < 3; ++c) content.coordinates[3 * kept + c] = content.coordinates[3 * i + c];
    ++kept;
  }
  content.node_tags.resize(kept);
  content.coordinates.resize(3 * kept);
  const auto renumber = [&](std::int32_t& node) { node = place[node]; };
  std::for_each(mesh.elements.begin(), mesh.elements.end(), renumber);
  for (ElementList& list : content.elements) std::for_each(list.nodes.begin(), list.nodes.end(), renumber);
}

/// Moves the coordinates into the mesh; in 2D drops z, which must be constant.
void take_coordinates(const std::string& path, MeshContent& content, Mesh& mesh) {
  mesh.coordinates = std::move(content.coordinates);
  if (mesh.dim() == 3) return;
  auto& x = mesh.coordinates;
  const std::size_t nodes = x.size() / 3;
  double low = x[0], high = x[0];
  for (std::size_t i = 0; i < nodes; ++i) {
    low = std::min({low, x[3 * i], x[3 * i + 1]});
    high = std::max({high, x[3 * i], x[3 * i + 1]});
  }
  for (std::size_t i = 0; i < nodes; ++i)
    if (!(std::abs(x[3 * i + 2] - x[2]) <= 1e-9 * (high - low)))
      throw InputError(path + ": the mesh is made of " + std::string(cell(mesh.type).name) + ", but node " +
                       std::to_string(content.node_tags[i]) + " has another z than node " +
                       std::to_string(content.node_tags[0]) +
                       ": a 2D body has to lie in a plane z = constant (shells are not supported)");
  for (std::size_t i = 0; i < nodes; ++i) {
    x[2 * i] = x[3 * i];
    x[2 * i + 1] = x[3 * i + 1];
  }
  x.resize(2 * nodes);
  x.shrink_to_fit();
}

/// Finds boundary facets by their corner nodes.
class FacetIndex {
 public:
  explicit FacetIndex(const Mesh& mesh) {
    const std::size_t corners = cell(mesh.type).facet().corners;
    entries_.reserve(mesh.facet_count());
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
      entries_.push_back({key(mesh.facet(f).first(corners)), static_cast<std::int32_t>(f)});
    std::sort(entries_.begin(), entries_.end());
  }

  /// Returns the facet with these corners; −1 if it is not on the boundary.
  std::int32_t find(std::span<const std::int32_t> corners) const {
    const Key wanted = key(corners);
    const auto place = std::lower_bound(entries_.begin(), entries_.end(), Entry{wanted, -1});
    return place != entries_.end() && place->first == wanted ? place->second : -1;
  }

 private:
  using Key = std::array<std::int32_t, 4>;
  using Entry = std::pair<Key, std::int32_t>;
  static Key key(std::span<const std::int32_t> corners) {
    Key result{-1, -1, -1, -1};
    std::copy(corners.begin(), corners.end(), result.begin());
    std::sort(result.begin(), result.end());
    return result;
  }
  std::vector<Entry> entries_;
};

class Groups {
 public:
  /// Members of one group; `inner` counts facets that are not on the boundary.
  struct Members {
    std::vector<std::int32_t> list;
    std::int64_t inner = 0;
  };

  Groups(const MeshContent& content, int dim) : content_(content), dim_(dim) {
    for (const auto& [key, name] : content.names)
      if (key.first <= dim) members_.try_emplace(key);
  }

  /// Calls member(element, members) for all elements of one type in each of their groups.
  template <typename Member>
  void add(std::size_t type, Member&& member) {
    const ElementList& list = content_.elements[type];
    for (std::size_t r = 0; r < list.runs.size(); ++r) {
      const std::size_t end = r + 1 < list.runs.size() ? list.runs[r + 1].first : list.count();
      for (const int physical : content_.physicals[list.runs[r].set]) {
        Members& members = members_[{dimension_of(type), physical}];
        for (std::size_t e = list.runs[r].first; e < end; ++e) member(e, members);
      }
    }
  }

  /// Returns one group per name and dimension.
  std::vector<Group> finish() {
    std::vector<Group> groups;
    for (auto& [key, found] : members_) {
      auto& [members, inner] = found;
      const auto named = content_.names.find(key);
      std::string name = named != content_.names.end() ? named->second : std::string();
      if (name.empty()) name = std::to_string(key.second);
      const auto same = std::find_if(
          groups.begin(), groups.end(),
          [&, dimension = key.first](const Group& g) { return g.dimension == dimension && g.name == name; });
      if (same == groups.end())
        groups.push_back({std::move(name), key.first, std::move(members), inner});
      else {
        same->members.insert(same->members.end(), members.begin(), members.end());
        same->inner += inner;
      }
    }
    for (Group& group : groups) {
      std::sort(group.members.begin(), group.members.end());
      group.members.erase(std::unique(group.members.begin(), group.members.end()), group.members.end());
    }
    std::stable_sort(groups.begin(), groups.end(),
                     [](const Group& a, const Group& b) { return a.dimension > b.dimension; });
    return groups;
  }

  int dim() const { return dim_; }

 private:
  const MeshContent& content_;
  int dim_;
  std::map<std::pair<int, int>, Members> members_;
};

std::vector<Group> find_groups(const MeshContent& content, std::size_t body, const Mesh& mesh) {
  Groups groups(content, mesh.dim());
  const FacetIndex facets(mesh);
  for (std::size_t s = 0; s < cells().size(); ++s) {
    const ElementList& list = content.elements[s];
    const auto nodes = [&](std::size_t e, int count) {
      return std::span(list.nodes).subspan(e * static_cast<std::size_t>(cells()[s].nodes), count);
    };
    if (s == body) {
      groups.add(s,
                 [](std::size_t e, auto& members) { members.list.push_back(static_cast<std::int32_t>(e)); });
    } else if (dimension_of(s) == mesh.dim() - 1) {
      groups.add(s, [&](std::size_t e, auto& members) {
        const std::int32_t facet = facets.find(nodes(e, cells()[s].corners));
        if (facet >= 0)
          members.list.push_back(facet);
        else
          ++members.inner;
      });
    } else {
      groups.add(s, [&](std::size_t e, auto& members) {
        const auto all = nodes(e, cells()[s].nodes);
        std::copy_if(all.begin(), all.end(), std::back_inserter(members.list),
                     [](std::int32_t node) { return node >= 0; });
      });
    }
  }
  return groups.finish();
}

/// Returns whether the numbers are 1, 2, 3 …, which a mesh need not store.
bool plain_numbers(const std::vector<std::int64_t>& tags) {
  for (std::size_t i = 0; i < tags.size(); ++i)
    if (tags[i] != static_cast<std::int64_t>(i) + 1) return false;
  return true;
}

}  // namespace

Mesh make_mesh(const std::string& path, MeshContent content) {
  const std::size_t body = body_cell(path, content);
  Mesh mesh;
  mesh.type = *element_type(cells()[body]);
  ElementList& elements = content.elements[body];
  mesh.elements = std::move(elements.nodes);
  drop_unused_nodes(path, content, mesh);
  take_coordinates(path, content, mesh);
  find_boundary(mesh);
  mesh.groups = find_groups(content, body, mesh);
  if (!plain_numbers(content.node_tags)) mesh.node_tags = std::move(content.node_tags);
  if (!plain_numbers(elements.tags)) mesh.element_tags = std::move(elements.tags);
  return mesh;
}

}  // namespace kacanov
