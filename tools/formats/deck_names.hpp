// SPDX-License-Identifier: BSD-3-Clause
// Finds unique names for sets and surfaces of a deck.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

/// Finds names that a case can refer to; adds a set or surface with a new name to the deck if no existing one
/// fits.
class DeckNames {
 public:
  explicit DeckNames(Deck& deck) : deck_(deck) {}

  /// Returns the unique name of a set in `sets` (node or element sets of the deck) that has exactly these
  /// members.
  std::string of(std::vector<DeckSet>& sets, std::vector<std::int32_t> members, const char* base);
  std::string of_sides(const std::vector<DeckSide>& sides);

 private:
  /// Number of sets and surfaces with the name; "all" is reserved.
  std::size_t owners(const std::string& name) const;
  std::string new_name(const std::string& base);

  Deck& deck_;
  std::map<std::string, int> last_;  ///< last number used in new names
};

}  // namespace kacanov
