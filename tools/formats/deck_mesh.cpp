// SPDX-License-Identifier: BSD-3-Clause
// Builds the mesh of a deck: sets and surfaces become groups.
#include <algorithm>
#include <map>

#include "formats/deck.hpp"
#include "formats/mesh_maker.hpp"

namespace kacanov {
namespace {

/// Collects group memberships and stores them as a mesh file with groups would.
class Grouping {
 public:
  explicit Grouping(MeshContent& content) : content_(content), members_(cells().size()) {}

  void add(std::size_t cell, std::int32_t element, int group) { members_[cell].emplace_back(element, group); }

  /// Adds a facet or point of its own to a group.
  void append(std::size_t cell, const std::vector<std::int32_t>& nodes, int group) {
    ElementList& list = content_.elements[cell];
    add(cell, static_cast<std::int32_t>(list.count()), group);
    list.nodes.insert(list.nodes.end(), nodes.begin(), nodes.end());
    list.tags.push_back(1);
  }

  void finish() {
    std::map<std::vector<int>, std::size_t> sets{{{}, 0}};
    for (std::size_t c = 0; c < members_.size(); ++c) {
      auto& pairs = members_[c];
      std::sort(pairs.begin(), pairs.end());
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
      std::int32_t next = 0;  // first element not yet in a run
      for (std::size_t i = 0; i < pairs.size();) {
        const std::int32_t element = pairs[i].first;
        std::vector<int> groups;
        for (; i < pairs.size() && pairs[i].first == element; ++i) groups.push_back(pairs[i].second);
        const auto [place, added] = sets.emplace(std::move(groups), content_.physicals.size());
        if (added) content_.physicals.push_back(place->first);
        if (next < element) begin(c, next, 0);
        begin(c, element, place->second);
        next = element + 1;
      }
      if (!pairs.empty() && static_cast<std::size_t>(next) < content_.elements[c].count()) begin(c, next, 0);
    }
  }

 private:
  void begin(std::size_t cell, std::int32_t first, std::size_t set) {
    auto& runs = content_.elements[cell].runs;
    if (runs.empty() || runs.back().set != set) runs.push_back({static_cast<std::size_t>(first), set});
  }

  MeshContent& content_;
  std::vector<std::vector<std::pair<std::int32_t, int>>> members_;  ///< by cell type: (element, group)
};

std::size_t place_of(const Cell& cell) { return static_cast<std::size_t>(&cell - cells().data()); }

/// Group name of a set; prefixed with the instance if a set outside the part has the same name.
template <typename Set>
std::string group_name(const std::vector<Set>& sets, const Set& set, const std::string& instance) {
  const std::string wanted = upper_case(set.name);
  const bool twice = std::any_of(sets.begin(), sets.end(), [&](const Set& other) {
    return other.in_part != set.in_part && upper_case(other.name) == wanted;
  });
  return twice && set.in_part ? instance + "." + set.name : set.name;
}

/// Adds one warning listing the parts of the deck that are not mesh.
void tell_what_is_left_out(Deck& deck) {
  std::string list;
  std::size_t count = 0;
  constexpr std::size_t most = 20;
  for (const DeckBlock& block : deck.blocks) {
    if (is_harmless(block.keyword.name)) continue;
    if (++count <= most)
      list += (list.empty() ? "" : ", ") + block.keyword.shown + " (" +
              (block.keyword.place.file == 0 ? "" : deck.files[block.keyword.place.file].path + ", ") +
              "line " + std::to_string(block.keyword.place.line) + ")";
  }
  if (count > most) list += " and " + std::to_string(count - most) + " more";
  if (count > 0)
    deck.warnings.push_back(deck.files[0].path + ": the mesh is read, and left out what is none: " + list +
                            "; kacanov convert makes a case of a whole deck");
}

}  // namespace

Mesh mesh_of(Deck deck) {
  tell_what_is_left_out(deck);
  MeshContent& content = deck.content;
  Grouping grouping(content);
  int group = 0;
  const std::size_t point =
      place_of(*std::find_if(cells().begin(), cells().end(), [](const Cell& c) { return c.dim == 0; }));
  const auto add_points = [&](const std::vector<std::int32_t>& nodes, const std::string& name) {
    content.names[{0, ++group}] = name;
    for (const std::int32_t node : nodes) grouping.append(point, {node}, group);
  };
  for (const DeckSet& set : deck.element_sets) {
    if (set.internal) continue;
    ++group;
    for (const std::int32_t e : set.members) {
      const auto [cell, place] = deck.elements[e];
      content.names[{cells()[cell].dim, group}] = group_name(deck.element_sets, set, deck.instance);
      grouping.add(cell, place, group);
    }
  }
  for (const DeckSurface& surface : deck.surfaces) {
    if (surface.internal) continue;
    const std::string name = group_name(deck.surfaces, surface, deck.instance);
    ++group;
    for (const DeckSide& side : surface.sides) {
      const Cell& facet = cells()[deck.elements[side.element].cell].facet();
      content.names[{facet.dim, group}] = name;
      grouping.append(place_of(facet), deck.side_nodes(side, {}), group);
    }
    if (!surface.nodes.empty()) add_points(surface.nodes, name);
  }
  for (const DeckSet& set : deck.node_sets)
    if (!set.internal) add_points(set.members, group_name(deck.node_sets, set, deck.instance));
  grouping.finish();
  Mesh mesh = make_mesh(deck.files[0].path, std::move(content));
  mesh.plane = deck.plane;
  mesh.warnings.insert(mesh.warnings.end(), deck.warnings.begin(), deck.warnings.end());
  return mesh;
}

}  // namespace kacanov
