// SPDX-License-Identifier: BSD-3-Clause
// What names and numbers in a deck mean.
#include "formats/deck.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <kacanov/error.hpp>
#include "formats/deck_elements.hpp"
#include "formats/gmsh_cursor.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

constexpr std::array harmless{"AMPLITUDE",      "CONTACTFILE",  "CONTACTOUTPUT",   "CONTACTPRINT",
                              "CONTROLS",       "DAMPING",      "DEPVAR",          "CONDUCTIVITY",
                              "ELFILE",         "ELPRINT",      "ELEMENTOUTPUT",   "ELEMENTFILE",
                              "ENERGYFILE",     "ENERGYOUTPUT", "ENERGYPRINT",     "FACEPRINT",
                              "FILEFORMAT",     "FILEOUTPUT",   "FILTER",          "FRICTION",
                              "HEADING",        "MONITOR",      "NODEFILE",        "NODEOUTPUT",
                              "NODEPRINT",      "ORIENTATION",  "OUTPUT",          "PHYSICALCONSTANTS",
                              "PREPRINT",       "PRINT",        "RESTART",         "SECTIONPRINT",
                              "SOLVERCONTROLS", "SPECIFICHEAT", "SURFACEBEHAVIOR", "SURFACEINTERACTION",
                              "TIMEPOINTS"};

/// The set of a name; names of Abaqus' one instance may stand before it.
template <typename Set>
const Set* find(const std::vector<Set>& sets, const std::string& instance, std::string_view name,
                bool in_part) {
  std::string wanted = upper_case(name);
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

bool is_harmless(const std::string& keyword) {
  return std::find(harmless.begin(), harmless.end(), keyword) != harmless.end();
}

std::string Deck::place_text(DeckPlace place) const {
  return files[place.file] + ": line " + std::to_string(place.line);
}

void Deck::fail(DeckPlace place, const std::string& message) const {
  throw InputError(place_text(place) + ": " + message);
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

std::vector<std::int32_t> Deck::nodes_of(std::string_view field, DeckPlace place, bool in_part) const {
  const std::string_view number = instance.empty() || !upper_case(field).starts_with(instance + ".")
                                      ? field
                                      : field.substr(instance.size() + 1);
  if (!is_number(number)) {
    if (const DeckSet* set = node_set(field, in_part)) return set->members;
    fail(place, "there is no set of nodes " + in_quotes(field) + " above");
  }
  std::int64_t tag = 0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), tag);
  const std::int32_t node = read.ec == std::errc() ? node_index.find(tag) : -1;
  if (node < 0) fail(place, "there is no node " + std::string(number.substr(0, 30)));
  return {node};
}

std::vector<std::int32_t> Deck::elements_of(std::string_view field, DeckPlace place, bool in_part) const {
  const std::string_view number = instance.empty() || !upper_case(field).starts_with(instance + ".")
                                      ? field
                                      : field.substr(instance.size() + 1);
  if (!is_number(number)) {
    if (const DeckSet* set = element_set(field, in_part)) return set->members;
    fail(place, "there is no set of elements " + in_quotes(field) + " above");
  }
  std::int64_t tag = 0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), tag);
  const std::int32_t element = read.ec == std::errc() ? element_index.find(tag) : -1;
  if (element < 0) fail(place, "there is no element " + std::string(number.substr(0, 30)));
  return {element};
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
    deck.fail(row.place,
              std::string("expected ") + what + ", got " + (text.empty() ? "nothing" : in_quotes(text)));
  return value;
}

double deck_number(const Deck& deck, const DeckRow& row, std::size_t field, const char* what) {
  const std::string_view text = field < row.fields.size() ? row.fields[field] : std::string_view();
  std::optional<double> value = to_number(text);
  if (!value && text.size() < 60) {
    std::string fortran(text);
    std::replace_if(
        fortran.begin(), fortran.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
    value = to_number(fortran);
  }
  if (!value)
    deck.fail(row.place,
              std::string("expected ") + what + ", got " + (text.empty() ? "nothing" : in_quotes(text)));
  return *value;
}

}  // namespace kacanov
