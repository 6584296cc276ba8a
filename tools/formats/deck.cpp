// SPDX-License-Identifier: BSD-3-Clause
// Resolves names and numbers in a deck.
#include "formats/deck.hpp"

#include <algorithm>
#include <charconv>

#include <kacanov/error.hpp>
#include "formats/deck_elements.hpp"
#include "formats/printable.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

/// Finds the set with a name; the name of Abaqus' instance may precede it.
template <typename Set>
const Set* find(const std::vector<Set>& sets, const std::string& instance, std::string_view name,
                bool in_part) {
  std::string wanted = upper_case(printable(name));
  bool anywhere = !in_part;
  if (!instance.empty() && wanted.starts_with(instance + ".")) {
    wanted.erase(0, instance.size() + 1);
    in_part = true;
    anywhere = false;
  }
  const Set* other = nullptr;
  for (const Set& set : sets) {
    if (upper_case(set.name) != wanted) continue;
    if (set.in_part == in_part) return &set;
    other = &set;
  }
  return anywhere ? other : nullptr;
}

bool is_number(std::string_view field) {
  return !field.empty() &&
         std::all_of(field.begin(), field.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string Deck::place_text(DeckPlace place) const {
  return files[place.file].path + ": line " + std::to_string(place.line);
}

void Deck::fail(DeckPlace place, const std::string& message) const {
  throw InputError(place_text(place) + ": " + message);
}

void Deck::expect_fields(const DeckRow& row, std::size_t most, const std::string& what) const {
  for (std::size_t f = most; f < row.fields.size(); ++f)
    if (!row.fields[f].empty())
      fail(row.place,
           "expected no more than " + what + ", got " + quoted(row.place, row.fields[f]) + " as well");
}

const DeckSet* Deck::node_set(std::string_view name, bool in_part) const {
  return find(node_sets, instance, name, in_part);
}
const DeckSet* Deck::element_set(std::string_view name, bool in_part) const {
  return find(element_sets, instance, name, in_part);
}
const DeckSurface* Deck::surface(std::string_view name, bool in_part) const {
  return find(surfaces, instance, name, in_part);
}

namespace {

/// Nodes or elements selected by a field of a data line: one number or a set.
struct Reference {
  const Deck& deck;
  const char* kind;  ///< node or element
  const std::vector<DeckSet>& sets;
  const NodeIndex& index;

  std::vector<std::int32_t> members(std::string_view field, DeckPlace place, bool in_part) const {
    const std::string& instance = deck.instance;
    const std::string_view number = instance.empty() || !upper_case(field).starts_with(instance + ".")
                                        ? field
                                        : field.substr(instance.size() + 1);
    const auto fail = [&](const std::string& before, const std::string& behind) {
      deck.fail(place, before + kind + behind);
    };
    const auto name = [&] { return deck.quoted(place, field); };
    if (!is_number(number)) {
      const DeckSet* set = find(sets, instance, field, in_part);
      if (set == nullptr) fail("there is no set of ", "s " + name() + " above");
      if (set->members.empty()) fail("the set of ", "s " + name() + " is empty");
      return set->members;
    }
    std::int64_t tag = 0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), tag);
    const std::int32_t found = read.ec == std::errc() ? index.find(tag) : -1;
    if (found < 0) fail("there is no ", " " + name());
    return {found};
  }
};

}  // namespace

std::vector<std::int32_t> Deck::nodes_of(std::string_view field, DeckPlace place, bool in_part) const {
  return Reference{*this, "node", node_sets, node_index}.members(field, place, in_part);
}

std::vector<std::int32_t> Deck::elements_of(std::string_view field, DeckPlace place, bool in_part) const {
  return Reference{*this, "element", element_sets, element_index}.members(field, place, in_part);
}

std::vector<std::int32_t> Deck::side_nodes(DeckSide side, DeckPlace place) const {
  const Element& element = elements[side.element];
  const auto facet = deck_side(element.cell, side.side);
  const Cell& cell = cells()[element.cell];
  if (facet.empty())
    fail(place, "element " + std::to_string(element_tags[side.element]) + " is a " + std::string(cell.name) +
                    ", which has no side " + std::to_string(side.side + 1));
  const std::int32_t* nodes = content.elements[element.cell].nodes.data() +
                              static_cast<std::size_t>(element.place) * static_cast<std::size_t>(cell.nodes);
  std::vector<std::int32_t> result;
  for (const std::int8_t k : facet) result.push_back(nodes[k]);
  return result;
}

std::int64_t deck_integer(const Deck& deck, const DeckRow& row, std::size_t field, const char* what) {
  std::string_view text = field < row.fields.size() ? row.fields[field] : std::string_view();
  if (text.starts_with('+')) text.remove_prefix(1);
  std::int64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc() || read.ptr != text.data() + text.size())
    deck.fail(row.place, std::string("expected ") + what + ", got " +
                             (text.empty() ? "nothing" : deck.quoted(row.place, text)));
  return value;
}

std::optional<double> deck_real(std::string_view word) {
  std::optional<double> value = to_number(word);
  constexpr std::size_t longest = 60;
  if (!value && word.size() < longest) {
    std::string fortran(word);
    std::replace_if(
        fortran.begin(), fortran.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
    value = to_number(fortran);
  }
  return value;
}

double deck_number(const Deck& deck, const DeckRow& row, std::size_t field, const char* what) {
  const std::string_view text = field < row.fields.size() ? row.fields[field] : std::string_view();
  const std::optional<double> value = deck_real(text);
  if (!value)
    deck.fail(row.place, std::string("expected ") + what + ", got " +
                             (text.empty() ? "nothing" : deck.quoted(row.place, text)));
  return *value;
}

}  // namespace kacanov
