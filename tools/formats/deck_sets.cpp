// SPDX-License-Identifier: BSD-3-Clause
// Resolves sets and surfaces of a deck; their lines may name nodes, elements and earlier sets.
#include "formats/deck_sets.hpp"

#include <algorithm>
#include <numeric>

#include "formats/deck_elements.hpp"
#include "formats/printable.hpp"

namespace kacanov {
namespace {

using Members = std::vector<std::int32_t>;

void sort_unique(Members& members) {
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
}

class Resolver {
 public:
  explicit Resolver(Deck& deck) : deck_(deck) {}

  void take(DeckSetSource& source) {
    const std::string& keyword = source.block.keyword.name;
    if (keyword == "SURFACE") {
      take_surface(source.block);
      return;
    }
    const bool nodes = keyword == "NODE" || keyword == "NSET";
    DeckSet& set = add(nodes ? deck_.node_sets : deck_.element_sets,
                       name_of(source.block, nodes ? "NSET" : "ELSET"), source.block);
    if (keyword == "NODE" || keyword == "ELEMENT") {
      const std::size_t before = set.members.size();
      set.members.resize(before + source.last - source.first);
      std::iota(set.members.begin() + static_cast<std::ptrdiff_t>(before), set.members.end(),
                static_cast<std::int32_t>(source.first));
    } else {
      // Evaluate first: the set may appear in its own lines, and adding sets reallocates the vector.
      Members found = members(source.block, nodes);
      set.members.insert(set.members.end(), found.begin(), found.end());
    }
    sort_unique(set.members);
  }

 private:
  std::string name_of(const DeckBlock& block, const char* parameter) {
    const std::string* name = block.keyword.parameter(parameter);
    if (name == nullptr || name->empty())
      deck_.fail(block.keyword.place, block.keyword.shown + ": expected " + parameter + "=<name>");
    if (name->find('"') != std::string::npos)
      deck_.fail(block.keyword.place, block.keyword.shown + ": the name " +
                                          quoted(block.keyword.place, *name) + " has quotes in it");
    return printable(*name);
  }

  std::string quoted(DeckPlace place, std::string_view word) const { return deck_.quoted(place, word); }

  template <typename Set>
  static Set& add(std::vector<Set>& sets, const std::string& name, const DeckBlock& block) {
    const std::string wanted = upper_case(name);
    for (Set& set : sets)
      if (set.in_part == block.in_part && upper_case(set.name) == wanted) return set;
    Set& set = sets.emplace_back();
    set.name = name;
    set.in_part = block.in_part;
    set.internal = block.keyword.parameter("INTERNAL") != nullptr;
    return set;
  }

  /// Checks INSTANCE, if given, against the only instance.
  void check_instance(const DeckKeyword& keyword) const {
    const std::string* name = keyword.parameter("INSTANCE");
    if (name != nullptr && upper_case(printable(*name)) != deck_.instance)
      deck_.fail(keyword.place, keyword.shown + ": there is no instance " + quoted(keyword.place, *name));
  }

  Members members(const DeckBlock& block, bool nodes) {
    Members found;
    check_instance(block.keyword);
    const std::string* elements = nodes ? block.keyword.parameter("ELSET") : nullptr;
    if (elements != nullptr && !block.rows.empty())
      deck_.fail(block.rows[0].place, "expected no lines of data beside ELSET=, whose nodes are the set");
    if (elements != nullptr)
      for (const std::int32_t e : deck_.elements_of(*elements, block.keyword.place, block.in_part)) {
        const Deck::Element& element = deck_.elements[e];
        const std::size_t count = cells()[element.cell].nodes;
        const auto& all = deck_.content.elements[element.cell].nodes;
        const auto first =
            all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(element.place) * count);
        found.insert(found.end(), first, first + static_cast<std::ptrdiff_t>(count));
      }
    const bool generate = block.keyword.parameter("GENERATE") != nullptr;
    const std::size_t most = 2 * (nodes ? deck_.content.node_tags.size() : deck_.elements.size()) + 1000;
    for (const DeckRow& row : block.rows) {
      if (generate) {
        add_range(row, nodes, found);
      } else {
        for (const std::string_view field : row.fields) {
          if (field.empty()) continue;
          const Members some = nodes ? deck_.nodes_of(field, row.place, block.in_part)
                                     : deck_.elements_of(field, row.place, block.in_part);
          found.insert(found.end(), some.begin(), some.end());
        }
      }
      if (found.size() > most) sort_unique(found);
    }
    return found;
  }

  /// Numbers missing from a range are allowed, but the range must contain at least one.
  void add_range(const DeckRow& row, bool nodes, Members& found) {
    deck_.expect_fields(row, 3, "the first and last number of a range, and its step");
    const std::int64_t first = deck_integer(deck_, row, 0, "the first number of a range"),
                       last = deck_integer(deck_, row, 1, "the last number of a range"),
                       step = row.fields.size() > 2 && !row.fields[2].empty()
                                  ? deck_integer(deck_, row, 2, "the step of a range")
                                  : 1;
    if (first < 0 || last < first || step < 1)
      deck_.fail(row.place, "expected a range: first, last not below it, and a step of 1 or more");
    const std::vector<std::int64_t>& tags = nodes ? deck_.content.node_tags : deck_.element_tags;
    const NodeIndex& index = nodes ? deck_.node_index : deck_.element_index;
    const std::size_t before = found.size();
    if ((last - first) / step < static_cast<std::int64_t>(tags.size())) {
      for (std::int64_t k = 0; k <= (last - first) / step; ++k)
        if (const std::int32_t i = index.find(first + k * step); i >= 0) found.push_back(i);
    } else {
      for (std::size_t i = 0; i < tags.size(); ++i)
        if (tags[i] >= first && tags[i] <= last && (tags[i] - first) % step == 0)
          found.push_back(static_cast<std::int32_t>(i));
    }
    if (found.size() == before)
      deck_.fail(row.place, std::string("there is no ") + (nodes ? "node" : "element") + " from " +
                                std::to_string(first) + " to " + std::to_string(last));
  }

  void take_surface(const DeckBlock& block) {
    const std::string* type = block.keyword.parameter("TYPE");
    const std::string kind = type == nullptr ? "ELEMENT" : upper_case(*type);
    const std::size_t before = deck_.surfaces.size();
    DeckSurface& surface = add(deck_.surfaces, name_of(block, "NAME"), block);
    if (deck_.surfaces.size() == before)
      deck_.fail(block.keyword.place, "a second surface " + quoted(block.keyword.place, surface.name) +
                                          ": expected all of it in one place");
    for (const DeckRow& row : block.rows) {
      if (row.fields[0].empty()) deck_.fail(row.place, "expected a set or a number");
      if (kind == "NODE") {
        // The second field is an area per node, which matters for contact only.
        deck_.expect_fields(row, 2, "a node or set and an area");
        if (row.fields.size() > 1 && !row.fields[1].empty()) deck_number(deck_, row, 1, "an area");
        const Members some = deck_.nodes_of(row.fields[0], row.place, block.in_part);
        surface.nodes.insert(surface.nodes.end(), some.begin(), some.end());
        continue;
      }
      add_sides(row, block.in_part, surface);
    }
    sort_unique(surface.nodes);
  }

  void add_sides(const DeckRow& row, bool in_part, DeckSurface& surface) {
    deck_.expect_fields(row, 2, "a set or element and a side");
    const std::string label = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
    if (label.size() != 2 || label[0] != 'S' || label[1] < '1' || label[1] > '6')
      deck_.fail(row.place, "expected a set or element and a side S1 to S6, got " +
                                (label.empty() ? "none" : quoted(row.place, label)) +
                                ": whole sets and sides of shells are not read");
    for (const std::int32_t element : deck_.elements_of(row.fields[0], row.place, in_part)) {
      const DeckSide side{element, label[1] - '1'};
      deck_.side_nodes(side, row.place);
      if (surface.sides.size() >= 8 * deck_.elements.size())
        deck_.fail(row.place, "the surface has more sides than the elements have");
      surface.sides.push_back(side);
    }
  }

  Deck& deck_;
};

}  // namespace

void resolve_sets(Deck& deck, std::vector<DeckSetSource> sources) {
  Resolver resolver(deck);
  for (DeckSetSource& source : sources) resolver.take(source);
}

}  // namespace kacanov
