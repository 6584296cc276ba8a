// SPDX-License-Identifier: BSD-3-Clause
// An Abaqus or CalculiX deck: nodes, elements, sets and surfaces, and all other keywords as text.
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

/// A keyword with its data lines.
struct DeckBlock {
  DeckKeyword keyword;
  std::vector<DeckRow> rows;
  bool in_part = false;  ///< between *PART and *END PART
  DeckLevel level = DeckLevel::model;
};

/// A set of nodes or elements.
struct DeckSet {
  std::string name;
  std::vector<std::int32_t> members;  ///< ascending: node indices, or indices into Deck::elements
  bool internal = false;              ///< internal to Abaqus; becomes no group
  bool in_part = false;
};

/// A side of an element; S1 or P1 has index 0.
struct DeckSide {
  std::int32_t element;
  std::int32_t side;
};

struct DeckSurface {
  std::string name;
  std::vector<DeckSide> sides;
  std::vector<std::int32_t> nodes;  ///< for TYPE=NODE
  bool internal = false;
  bool in_part = false;
};

struct Deck {
  struct Element {
    std::int32_t cell;   ///< index into cells()
    std::int32_t place;  ///< index into the list of its type in `content`
  };

  std::vector<SourceFile> files;
  std::vector<std::shared_ptr<const void>> bytes;  ///< memory that the fields of `blocks` refer to
  std::string title;
  std::string instance;  ///< name of Abaqus' only instance, in upper case; names may start with it and a dot
  MeshContent content;   ///< without groups
  std::vector<Element> elements;
  std::vector<std::int64_t> element_tags;
  NodeIndex node_index, element_index;
  std::vector<DeckSet> node_sets, element_sets;
  std::vector<DeckSurface> surfaces;
  PlaneState plane = PlaneState::strain;  ///< plane state of 2D elements
  std::vector<DeckBlock> blocks;  ///< all keywords except nodes, elements, sets and surfaces, in deck order
  std::optional<DeckPlace> open_step;  ///< place of a *STEP that has no *END STEP
  std::vector<std::string> warnings;

  [[noreturn]] void fail(DeckPlace place, const std::string& message) const;
  /// Returns "part.inp: line 12".
  std::string place_text(DeckPlace place) const;
  /// Returns a word of the file at that place as messages may quote it.
  std::string quoted(DeckPlace place, std::string_view word) const { return files[place.file].quoted(word); }
  /// Throws InputError if the row has more than `most` fields, not counting empty ones; `what` describes the
  /// fields.
  void expect_fields(const DeckRow& row, std::size_t most, const std::string& what) const;

  /// Returns the set or surface with that name; null if there is none.
  const DeckSet* node_set(std::string_view name, bool in_part) const;
  const DeckSet* element_set(std::string_view name, bool in_part) const;
  const DeckSurface* surface(std::string_view name, bool in_part) const;

  /// Returns the members that a field selects by number or set name; throws InputError for an unknown name or
  /// an empty set.
  std::vector<std::int32_t> nodes_of(std::string_view field, DeckPlace place, bool in_part) const;
  std::vector<std::int32_t> elements_of(std::string_view field, DeckPlace place, bool in_part) const;
  /// Returns the nodes of an element side ("S3" or "P3") in our order; throws InputError if the element has
  /// no such side.
  std::vector<std::int32_t> side_nodes(DeckSide side, DeckPlace place) const;
};

/// Reads a deck from a file or from memory; a deck in memory cannot include files. Throws InputError "path:
/// line N: ...".
Deck read_deck(const SourceFile& source);
Deck read_deck(const SourceFile& name, std::string_view bytes);

/// Returns the mesh of a deck, with sets and surfaces as groups. A warning lists the keywords that are not
/// part of a mesh, with their lines.
Mesh mesh_of(Deck deck);

/// Returns the value of a number, also with a Fortran exponent (1.5D3).
std::optional<double> deck_real(std::string_view word);
/// Returns the number in a field; throws InputError naming the expected value (`what`).
double deck_number(const Deck& deck, const DeckRow& row, std::size_t field, const char* what);
std::int64_t deck_integer(const Deck& deck, const DeckRow& row, std::size_t field, const char* what);

}  // namespace kacanov
