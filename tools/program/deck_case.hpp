// SPDX-License-Identifier: BSD-3-Clause
// Converts an Abaqus or CalculiX deck to a case and its mesh.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

struct DeckCase {
  nlohmann::ordered_json document;   ///< without its mesh
  Mesh mesh;                         ///< with a group for every selection in the document
  std::string temperatures;          ///< content of the nodal file for the key "temperature"; empty: none
  std::vector<std::string> remarks;  ///< sentences: what was skipped, or has another meaning here
  /// Pairs of a case key, "material[0].plastic[1]", and the line of the deck it comes from, "part.inp: line
  /// 12".
  std::vector<std::pair<std::string, std::string>> places;

  /// Prefixes a message that begins with a case key with the line of the deck.
  std::string with_line(const std::string& message) const;
};

/// Converts a deck with one static step to a case. Throws InputError "path: line N: ..." for unsupported
/// input, including unknown keywords that change the solution; with `leave_out` the latter are listed in the
/// remarks instead.
DeckCase case_of(Deck deck, bool leave_out);

}  // namespace kacanov
