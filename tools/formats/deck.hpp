// SPDX-License-Identifier: BSD-3-Clause
// An Abaqus or CalculiX deck: its nodes, elements, sets and surfaces, and its other keywords as they stand.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kacanov/mesh.hpp>
#include "formats/deck_keywords.hpp"
#include "formats/deck_lines.hpp"
#include "formats/mesh_content.hpp"
#include "formats/node_index.hpp"

namespace kacanov {

/// A keyword with its lines of data.
struct DeckBlock {
  DeckKeyword keyword;
  std::vector<DeckRow> rows;
  bool in_part = false;  ///< between *PART and *END PART
  DeckLevel level = DeckLevel::model;
};

/// A set of nodes or elements.
struct DeckSet {
  std::string name;
  std::vector<std::int32_t> members;  ///< ascending: indices of nodes, or into Deck::elements
  bool internal = false;              ///< Abaqus' own, which no group is made of
  bool in_part = false;
};

/// A side of an element: S1 or P1 is 0.
struct DeckSide {
  std::int32_t element;
  std::int32_t side;
};

struct DeckSurface {
  std::string name;
  std::vector<DeckSide> sides;
  std::vector<std::int32_t> nodes;  ///< of one of TYPE=NODE
  bool internal = false;
  bool in_part = false;
};

struct Deck {
  struct Element {
    std::int32_t cell;   ///< among cells()
    std::int32_t place;  ///< in the content's list of its type
  };

  std::vector<SourceFile> files;
  std::vector<std::shared_ptr<const void>> bytes;  ///< what the blocks' fields lie in
  std::string title;
  std::string instance;  ///< of Abaqus' one part, in upper case; names may begin with it and a dot
  MeshContent content;   ///< without groups
  std::vector<Element> elements;
  std::vector<std::int64_t> element_tags;
  NodeIndex node_index, element_index;
  std::vector<DeckSet> node_sets, element_sets;
  std::vector<DeckSurface> surfaces;
  PlaneState plane = PlaneState::strain;  ///< what elements in 2D are of
  std::vector<DeckBlock> blocks;  ///< all but nodes, elements, sets and surfaces, in the order of the deck
  std::optional<DeckPlace> open_step;  ///< of a *STEP without *END STEP
  std::vector<std::string> warnings;

  [[noreturn]] void fail(DeckPlace place, const std::string& message) const;
  /// "part.inp: line 12".
  std::string place_text(DeckPlace place) const;
  /// A word of the file at that place for a message.
  std::string quoted(DeckPlace place, std::string_view word) const { return files[place.file].quoted(word); }
  /// Throws InputError for a row that has more than `most` fields, other than empty ones; `what` names them.
  void expect_fields(const DeckRow& row, std::size_t most, const std::string& what) const;

  /// The set or surface that a name means there; null where there is none.
  const DeckSet* node_set(std::string_view name, bool in_part) const;
  const DeckSet* element_set(std::string_view name, bool in_part) const;
  const DeckSurface* surface(std::string_view name, bool in_part) const;

  /// The members that a field names by a number or the name of a set; throws InputError for an unknown name
  /// and an empty set.
  std::vector<std::int32_t> nodes_of(std::string_view field, DeckPlace place, bool in_part) const;
  std::vector<std::int32_t> elements_of(std::string_view field, DeckPlace place, bool in_part) const;
  /// The side that "S3" or "P3" says of an element, which has to have one; its nodes in our order.
  std::vector<std::int32_t> side_nodes(DeckSide side, DeckPlace place) const;
};

/// Reads a deck from a file, or from the bytes of one; then it may include no others. Throws InputError
/// "path: line N: ...".
Deck read_deck(const SourceFile& source);
Deck read_deck(const SourceFile& name, std::string_view bytes);

/// The mesh of a deck: sets and surfaces are its groups. Keywords that are no part of a mesh are told in a
/// warning, with their lines.
Mesh mesh_of(Deck deck);

/// The number that a word is, with Fortran's exponents too.
std::optional<double> deck_real(std::string_view word);
/// The number in a field; throws InputError saying what was expected there.
double deck_number(const Deck& deck, const DeckRow& row, std::size_t field, const char* what);
std::int64_t deck_integer(const Deck& deck, const DeckRow& row, std::size_t field, const char* what);

}  // namespace kacanov
