// SPDX-License-Identifier: BSD-3-Clause
// The temperatures of a deck's nodes, and what they are warmer by than at the start.
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
  std::vector<double> at_start = {}, at_end = {};  ///< by node; NaN, or empty: nothing is said

  explicit DeckTemperatures(const Deck& of) : deck(of) {}

  /// The rows of *TEMPERATURE or *INITIAL CONDITIONS, into one of these.
  void take(const DeckBlock& block, std::vector<double>& of_node) const;
  /// By the numbers of the nodes that are wanted. Of which none is said, at the start are at 0, and stay as
  /// they are there. Empty where the step says of none.
  std::map<std::int64_t, double> rise(const std::vector<bool>& wanted) const;
};

/// What all have, 0 of none; nothing where they differ.
std::optional<double> one_value(const std::map<std::int64_t, double>& rise);
/// A file of nodes for the key "temperature" of a case.
std::string lines_of(const std::map<std::int64_t, double>& rise);

}  // namespace kacanov
