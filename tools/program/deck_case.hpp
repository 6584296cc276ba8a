// SPDX-License-Identifier: BSD-3-Clause
// From a whole Abaqus or CalculiX deck to a case and its mesh.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

struct DeckCase {
  nlohmann::ordered_json document;   ///< without its mesh
  Mesh mesh;                         ///< with a group for everything that the document names
  std::string temperatures;          ///< lines of a file of nodes that "temperature" of an entry is to name
  std::vector<std::string> remarks;  ///< what was left out, or means something else here; a sentence each
  /// "material[0].plastic[1]" and the line of the deck that it comes from, "part.inp: line 12".
  std::vector<std::pair<std::string, std::string>> places;

  /// A message about the case, which begins with the path of a key, with the line of the deck before it.
  std::string with_line(const std::string& message) const;
};

/// Makes a case of a deck of one static step. Throws InputError "path: line N: ..." for what cannot be part
/// of one. Keywords that change the answer and are not known are refused too; with `leave_out` they are named
/// in the remarks instead.
DeckCase case_of(Deck deck, bool leave_out);

}  // namespace kacanov
