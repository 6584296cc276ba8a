// SPDX-License-Identifier: BSD-3-Clause
// The sets and surfaces of a deck, whose lines may name nodes, elements and sets before them.
#pragma once

#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

/// Where a set comes from: a keyword of its own, or what *NODE or *ELEMENT has put into it.
struct DeckSetSource {
  DeckBlock block;
  std::size_t first, last;  ///< of *NODE and *ELEMENT: those from first to before last
};

/// Fills the deck's sets and surfaces, once its nodes and elements are there.
void resolve_sets(Deck& deck, std::vector<DeckSetSource> sources);

}  // namespace kacanov
