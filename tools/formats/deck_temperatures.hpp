// SPDX-License-Identifier: BSD-3-Clause
// Nodal temperatures of a deck, and their rise over the initial temperature.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

struct DeckTemperatures {
  const Deck& deck;
  std::vector<double> at_start = {}, at_end = {};  ///< one per node; NaN, or empty: not given

  explicit DeckTemperatures(const Deck& of) : deck(of) {}

  /// Reads the rows of *TEMPERATURE or *INITIAL CONDITIONS into one of these arrays.
  void take(const DeckBlock& block, std::vector<double>& of_node) const;
  /// Returns the temperature rise by number of the wanted nodes. Without an initial temperature a node starts
  /// at 0; without a step temperature its rise is 0. Empty if the step sets no temperature.
  std::map<std::int64_t, double> rise(const std::vector<bool>& wanted) const;
};

/// Returns the common value of all nodes, 0 if there are none; nothing if they differ.
std::optional<double> one_value(const std::map<std::int64_t, double>& rise);
/// Returns the content of a nodal file for the case key "temperature".
std::string lines_of(const std::map<std::int64_t, double>& rise);

}  // namespace kacanov
