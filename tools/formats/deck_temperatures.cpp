// SPDX-License-Identifier: BSD-3-Clause
// Nodal temperatures of a deck, and their rise over the initial temperature.
#include "formats/deck_temperatures.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace kacanov {

void DeckTemperatures::take(const DeckBlock& block, std::vector<double>& of_node) const {
  of_node.resize(deck.content.node_tags.size(), std::numeric_limits<double>::quiet_NaN());
  for (const DeckRow& row : block.rows) {
    deck.expect_fields(row, 2, "a node or set and a temperature");
    const double value = deck_number(deck, row, 1, "a temperature");
    for (const std::int32_t node : deck.nodes_of(row.fields[0], row.place, block.in_part))
      of_node[node] = value;
  }
}

std::map<std::int64_t, double> DeckTemperatures::rise(const std::vector<bool>& wanted) const {
  std::map<std::int64_t, double> rise;
  for (std::size_t n = 0; n < at_end.size(); ++n) {
    if (!wanted[n]) continue;
    const double start = at_start.empty() || std::isnan(at_start[n]) ? 0.0 : at_start[n];
    rise[deck.content.node_tags[n]] = std::isnan(at_end[n]) ? 0.0 : at_end[n] - start;
  }
  return rise;
}

std::optional<double> one_value(const std::map<std::int64_t, double>& rise) {
  if (rise.empty()) return 0.0;
  const double first = rise.begin()->second;
  const bool even =
      std::all_of(rise.begin(), rise.end(), [&](const auto& node) { return node.second == first; });
  return even ? std::optional(first) : std::nullopt;
}

std::string lines_of(const std::map<std::int64_t, double>& rise) {
  std::string lines = "# node, by how much warmer than at the start\n";
  for (const auto& [tag, value] : rise) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    lines += std::to_string(tag) + ", " + std::string(digits.data(), end) + "\n";
  }
  return lines;
}

}  // namespace kacanov
