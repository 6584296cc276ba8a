// SPDX-License-Identifier: BSD-3-Clause
// Names of a deck's sets and surfaces that stand for one thing alone.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

/// Finds names for what a case refers to; where none will do, a set or surface of a new one is added to the
/// deck.
class DeckNames {
 public:
  explicit DeckNames(Deck& deck) : deck_(deck) {}

  /// Of one of `sets`, which are of the deck, with these members and a name that nothing else has.
  std::string of(std::vector<DeckSet>& sets, std::vector<std::int32_t> members, const char* base);
  std::string of_sides(const std::vector<DeckSide>& sides);

 private:
  /// How many sets and surfaces have the name; "all" has a meaning of its own.
  std::size_t owners(const std::string& name) const;
  std::string new_name(const std::string& base);

  Deck& deck_;
  std::map<std::string, int> last_;  ///< numbers of new names
};

}  // namespace kacanov
