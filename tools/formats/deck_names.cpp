// SPDX-License-Identifier: BSD-3-Clause
// Finds unique names for sets and surfaces of a deck.
#include "formats/deck_names.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace kacanov {

std::string DeckNames::of(std::vector<DeckSet>& sets, std::vector<std::int32_t> members, const char* base) {
  for (DeckSet& set : sets)
    if (set.members == members && owners(set.name) == 1) {
      set.internal = false;
      return set.name;
    }
  DeckSet& set = sets.emplace_back();
  set.name = new_name(base);
  set.members = std::move(members);
  return set.name;
}

std::string DeckNames::of_sides(const std::vector<DeckSide>& sides) {
  const auto places = [](const std::vector<DeckSide>& list) {
    std::set<std::pair<std::int32_t, std::int32_t>> all;
    for (const DeckSide& side : list) all.emplace(side.element, side.side);
    return all;
  };
  for (DeckSurface& surface : deck_.surfaces)
    if (surface.nodes.empty() && owners(surface.name) == 1 && places(surface.sides) == places(sides)) {
      surface.internal = false;
      return surface.name;
    }
  DeckSurface surface;
  surface.name = new_name("pressed");
  surface.sides = sides;
  deck_.surfaces.push_back(surface);
  return surface.name;
}

std::size_t DeckNames::owners(const std::string& name) const {
  std::size_t count = name == "all" ? 2 : 0;
  const std::string wanted = upper_case(name);
  const auto same = [&](const auto& set) { return upper_case(set.name) == wanted; };
  for (const auto* sets : {&deck_.node_sets, &deck_.element_sets})
    count += static_cast<std::size_t>(std::count_if(sets->begin(), sets->end(), same));
  return count + static_cast<std::size_t>(std::count_if(deck_.surfaces.begin(), deck_.surfaces.end(), same));
}

std::string DeckNames::new_name(const std::string& base) {
  for (;;) {
    std::string name = base + "_" + std::to_string(++last_[base]);
    if (owners(name) == 0) return name;
  }
}

}  // namespace kacanov
