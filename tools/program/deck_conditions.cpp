// SPDX-License-Identifier: BSD-3-Clause
// Boundary conditions of a deck: displacements, forces, pressures, gravity and temperatures.
#include "program/deck_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kacanov {

DeckConditions::DeckConditions(const Deck& deck, Change change)
    : deck_(deck), change_(std::move(change)), temperatures_(deck) {
  for (const Deck::Element& element : deck.elements) dim_ = std::max(dim_, cells()[element.cell].dim);
  in_body_.resize(deck.content.node_tags.size());
  for (std::size_t c = 0; c < cells().size(); ++c)
    if (cells()[c].dim == dim_)
      for (const std::int32_t node : deck.content.elements[c].nodes) in_body_[node] = true;
}

bool DeckConditions::take(const DeckBlock& block) {
  const std::string& name = block.keyword.name;
  if (name == "BOUNDARY") {
    take_boundary(block);
  } else if (name == "TEMPERATURE") {
    temperatures_.take(block, temperatures_.at_end);
  } else if (name == "INITIALCONDITIONS") {
    const std::string* type = block.keyword.parameter("TYPE");
    if (type != nullptr && upper_case(*type) == "TEMPERATURE")
      temperatures_.take(block, temperatures_.at_start);
    else
      change_(block, "it is not known here, but TYPE=TEMPERATURE");
  } else if (name == "CLOAD") {
    for (const DeckRow& row : block.rows) take_point_load(row, block.in_part);
  } else if (name == "DLOAD") {
    for (const DeckRow& row : block.rows) take_element_load(block, row);
  } else if (name == "DSLOAD") {
    for (const DeckRow& row : block.rows) take_surface_load(block, row);
  } else {
    return false;
  }
  return true;
}

void DeckConditions::take_boundary(const DeckBlock& block) {
  // OP=NEW removes earlier conditions; without any it has no effect.
  const std::string* op = block.keyword.parameter("OP");
  if (op != nullptr && upper_case(*op) == "NEW" && !held_.empty())
    change_(block, "OP=NEW removes conditions that were given before, which is not known here");
  for (const DeckRow& row : block.rows) {
    held_.resize(deck_.content.node_tags.size(), {is_free, is_free, is_free});
    const std::vector<std::int32_t> nodes = deck_.nodes_of(row.fields[0], row.place, block.in_part);
    const std::string word = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
    static const std::map<std::string, std::pair<int, int>> words{
        {"ENCASTRE", {1, 3}}, {"PINNED", {1, 3}}, {"XSYMM", {1, 1}}, {"YSYMM", {2, 2}}, {"ZSYMM", {3, 3}}};
    if (const auto known = words.find(word); known != words.end()) {
      deck_.expect_fields(row, 2, "a node or set and " + word);
      hold(nodes, known->second, 0.0);
      continue;
    }
    deck_.expect_fields(row, 4, "a node or set, the first and last degree of freedom and a displacement");
    const std::int64_t first = deck_integer(deck_, row, 1, "a degree of freedom"),
                       last = row.fields.size() > 2 && !row.fields[2].empty()
                                  ? deck_integer(deck_, row, 2, "the last degree of freedom")
                                  : first;
    const double value =
        row.fields.size() > 3 && !row.fields[3].empty() ? deck_number(deck_, row, 3, "a displacement") : 0.0;
    if (first < 1 || last < first || last > 6)
      deck_.fail(row.place,
                 "expected degrees of freedom 1 to 3 (4 to 6, rotations, say nothing of solids), got " +
                     std::to_string(first) + " to " + std::to_string(last));
    if (last > dim_ && first <= 3 && dim_ == 2 && value != 0.0)
      deck_.fail(row.place, "a plane body does not move across its plane");
    hold(nodes, {static_cast<int>(first), static_cast<int>(last)}, value);
  }
}

/// A later line overrides an earlier one.
void DeckConditions::hold(const std::vector<std::int32_t>& nodes, std::pair<int, int> directions,
                          double value) {
  for (const std::int32_t node : nodes)
    for (int c = directions.first; c <= std::min(directions.second, dim_) && in_body_[node]; ++c)
      held_[node][static_cast<std::size_t>(c) - 1] = value;
}

/// Loads of a step are summed, as in CalculiX.
void DeckConditions::take_point_load(const DeckRow& row, bool in_part) {
  forces_.resize(deck_.content.node_tags.size(), Triple{});
  deck_.expect_fields(row, 3, "a node or set, a degree of freedom and a force");
  const std::int64_t direction = deck_integer(deck_, row, 1, "a degree of freedom");
  if (direction < 1 || direction > dim_)
    deck_.fail(row.place, "expected a degree of freedom 1 to " + std::to_string(dim_) + ", got " +
                              std::to_string(direction) + ": moments do not act on nodes of solids");
  const double value = deck_number(deck_, row, 2, "a force");
  for (const std::int32_t node : deck_.nodes_of(row.fields[0], row.place, in_part)) {
    if (!in_body_[node])
      deck_.fail(row.place, "node " + std::to_string(deck_.content.node_tags[node]) +
                                " is loaded and belongs to no element of the body");
    forces_[node][static_cast<std::size_t>(direction) - 1] += value;
  }
}

void DeckConditions::take_element_load(const DeckBlock& block, const DeckRow& row) {
  const std::string label = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
  std::vector<std::int32_t> elements(deck_.elements.size());
  std::iota(elements.begin(), elements.end(), 0);
  if (!row.fields[0].empty()) elements = deck_.elements_of(row.fields[0], row.place, block.in_part);
  if (label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6') {
    deck_.expect_fields(row, 3, "an element or set, a side and a pressure");
    const double value = deck_number(deck_, row, 2, "a pressure");
    for (const std::int32_t element : elements) press({element, label[1] - '1'}, row.place, value);
  } else if (label == "GRAV") {
    deck_.expect_fields(row, 6, "an element or set, GRAV, an acceleration and its direction");
    const double value = deck_number(deck_, row, 2, "an acceleration");
    Triple direction{};
    for (std::size_t c = 0; c < 3; ++c)
      if (3 + c < row.fields.size() && !row.fields[3 + c].empty())
        direction[c] = deck_number(deck_, row, 3 + c, "a direction");
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    if (!(length > 0.0)) deck_.fail(row.place, "expected a direction of gravity");
    if (dim_ == 2 && direction[2] != 0.0)
      deck_.fail(row.place, "expected a direction of gravity in the plane of the body");
    for (double& component : direction) component *= value / length;
    gravity_.push_back({row.place, std::move(elements), direction});
  } else {
    change_(block, "loads of the kind " + deck_.quoted(row.place, label) +
                       " are not known here, but P1 to P6 and GRAV");
  }
}

void DeckConditions::take_surface_load(const DeckBlock& block, const DeckRow& row) {
  const std::string label = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
  if (label != "P") {
    change_(block, "loads of the kind " + deck_.quoted(row.place, label) + " are not known here, but P");
    return;
  }
  deck_.expect_fields(row, 3, "a surface, P and a pressure");
  const DeckSurface* surface = deck_.surface(row.fields[0], block.in_part);
  if (surface == nullptr)
    deck_.fail(row.place, "there is no surface " + deck_.quoted(row.place, row.fields[0]));
  if (surface->sides.empty())
    deck_.fail(row.place,
               "the surface " + deck_.quoted(row.place, row.fields[0]) + " has no sides of elements");
  const double value = deck_number(deck_, row, 2, "a pressure");
  for (const DeckSide& side : surface->sides) press(side, row.place, value);
}

void DeckConditions::press(DeckSide side, DeckPlace place, double value) {
  if (cells()[deck_.elements[side.element].cell].dim != dim_)
    deck_.fail(place, "element " + std::to_string(deck_.element_tags[side.element]) +
                          " is pressed and is no " + "element of the body");
  deck_.side_nodes(side, place);  // throws if the element has no such side
  Pressure& there = pressures_[{side.element, side.side}];
  there.value += value;
  there.place = place;
}

}  // namespace kacanov
