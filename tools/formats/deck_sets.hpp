// SPDX-License-Identifier: BSD-3-Clause
// Resolves sets and surfaces of a deck; their lines may name nodes, elements and earlier sets.
#pragma once

#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

/// Source of a set: its own keyword, or a *NODE or *ELEMENT that adds to it.
struct DeckSetSource {
  DeckBlock block;
  std::size_t first, last;  ///< for *NODE and *ELEMENT: range [first, last) of their nodes or elements
};

/// Fills the sets and surfaces of the deck after all nodes and elements are read.
void resolve_sets(Deck& deck, std::vector<DeckSetSource> sources);

}  // namespace kacanov
