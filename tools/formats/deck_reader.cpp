// SPDX-License-Identifier: BSD-3-Clause
// Reads a deck: nodes and elements directly, sets and surfaces once all of them are known.
#include <algorithm>
#include <limits>
#include <utility>

#include <kacanov/error.hpp>
#include "formats/deck.hpp"
#include "formats/deck_elements.hpp"
#include "formats/deck_sets.hpp"
#include "formats/mapped_file.hpp"
#include "formats/text_bytes.hpp"

namespace kacanov {
namespace {

/// Keywords that generate or move nodes and elements.
constexpr std::array generators{"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBMODEL"};
constexpr std::array brackets{"PART",     "ENDPART",     "INSTANCE", "ENDINSTANCE",
                              "ASSEMBLY", "ENDASSEMBLY", "ENDSTEP"};
/// Node count of the largest supported element, plus its number.
constexpr std::size_t most_fields = most_nodes + 1;

class Reader {
 public:
  Reader(const SourceFile& source, std::string_view bytes, DeckLines::Open open)
      : in_(source, bytes, std::move(open)) {}

  Deck read() {
    while (const auto keyword = in_.keyword()) take(*keyword);
    deck_.files = in_.files();
    const std::string& path = deck_.files[0].path;
    if (deck_.content.node_tags.empty()) throw InputError(path + ": expected nodes, *NODE");
    if (deck_.element_tags.empty()) throw InputError(path + ": expected elements, *ELEMENT");
    number_nodes();
    place_elements();
    resolve_sets(deck_, std::move(sets_));
    return std::move(deck_);
  }

 private:
  void take(const DeckKeyword& keyword) {
    const std::string& name = keyword.name;
    if (name == "NODE") {
      check(keyword);
      take_nodes(keyword);
    } else if (name == "ELEMENT") {
      check(keyword);
      take_elements(keyword);
    } else if (name == "HEADING") {
      check(keyword);
      take_title();
    } else if (std::find(brackets.begin(), brackets.end(), name) != brackets.end()) {
      check(keyword);
      take_bracket(keyword);
    } else if (std::find(generators.begin(), generators.end(), name) != generators.end()) {
      in_.fail(keyword.place, keyword.shown +
                                  " makes or moves nodes or elements, which is not read: write them "
                                  "out, as with a mesh generator or Abaqus/CAE");
    } else {
      take_block(keyword);
    }
  }

  /// Checks the place and the parameters of a keyword that belongs to the mesh.
  void check(const DeckKeyword& keyword) const {
    std::vector<std::string> faults = parameter_faults(keyword);
    if (const std::string fault = level_fault(*deck_rule(keyword.name), level_); !fault.empty())
      faults.insert(faults.begin(), fault);
    if (!faults.empty()) in_.fail(keyword.place, keyword.shown + ": " + faults[0]);
  }

  void take_block(const DeckKeyword& keyword) {
    const std::string& name = keyword.name;
    const bool set = name == "NSET" || name == "ELSET" || name == "SURFACE";
    if (set) check(keyword);
    if (name == "STEP") {
      if (in_part_) in_.fail(keyword.place, keyword.shown + ": expected *END PART before it");
      level_ = DeckLevel::step;
      deck_.open_step = keyword.place;
    }
    DeckBlock block{keyword, {}, in_part_, level_};
    for (DeckRow row; in_.data(row);) block.rows.push_back(row);
    if (set)
      sets_.push_back({std::move(block), 0, 0});
    else
      deck_.blocks.push_back(std::move(block));
  }

  void take_title() {
    for (DeckRow row; in_.data(row);)
      for (const std::string_view field : row.fields)
        deck_.title += (deck_.title.empty() ? "" : " ") + std::string(field);
  }

  /// Begins or ends a part, its instance or the assembly, or ends a step. Abaqus/CAE writes each body as one
  /// part with one instance in its original position.
  void take_bracket(const DeckKeyword& keyword) {
    const std::string& name = keyword.name;
    if (DeckRow row; in_.data(row))
      in_.fail(row.place,
               name == "INSTANCE"
                   ? keyword.shown + " moves the part, which is not read: place it where it belongs"
                   : keyword.shown + " has no lines of data, got " + in_.quoted(row.place, row.fields[0]));
    if (name == "ENDSTEP") {
      if (level_ != DeckLevel::step) in_.fail(keyword.place, keyword.shown + ": it ends no *STEP");
      level_ = DeckLevel::behind;
      deck_.open_step.reset();
    } else if (name == "ASSEMBLY" || name == "PART" || name == "INSTANCE") {
      if (in_part_) in_.fail(keyword.place, keyword.shown + ": expected *END PART before it");
    }
    if (name == "PART" || name == "INSTANCE") {
      const bool part = name == "PART";
      if (std::exchange(part ? have_part_ : have_instance_, true))
        in_.fail(keyword.place,
                 "a second " + keyword.shown + ": a deck of one body is read, which is one part");
      in_part_ = part;
      const std::string *own = keyword.parameter("NAME"), *of = keyword.parameter("PART");
      if (!part && of != nullptr && upper_case(*of) != part_)
        in_.fail(keyword.place, keyword.shown + ": there is no part " + in_.quoted(keyword.place, *of));
      if (own != nullptr) (part ? part_ : deck_.instance) = upper_case(part ? *own : printable(*own));
    } else if (name == "ENDPART") {
      in_part_ = false;
    }
  }

  /// Returns the deck so far, which converts the numbers of a row and names its place.
  const Deck& deck() {
    if (deck_.files.size() != in_.files().size()) deck_.files = in_.files();  // a file was included
    return deck_;
  }

  std::int64_t number(const DeckRow& row, std::size_t field, const char* what) {
    return deck_integer(deck(), row, field, what);
  }

  void take_nodes(const DeckKeyword& keyword) {
    MeshContent& content = deck_.content;
    const std::size_t first = content.node_tags.size();
    for (DeckRow row; in_.data(row);) {
      deck().expect_fields(row, 4, "the number of a node and three coordinates");
      if (content.node_tags.size() >= std::numeric_limits<std::int32_t>::max() / 3)
        in_.fail(row.place, "more nodes than 32-bit indices can number");
      const std::int64_t tag = number(row, 0, "the number of a node");
      if (tag <= 0) in_.fail(row.place, "expected a positive number of a node, got " + std::to_string(tag));
      content.node_tags.push_back(tag);
      for (std::size_t c = 1; c <= 3; ++c)
        content.coordinates.push_back(c < row.fields.size() && !row.fields[c].empty()
                                          ? deck_number(deck_, row, c, "a coordinate")
                                          : 0.0);
      node_places_.push_back(row.place);
    }
    if (keyword.parameter("NSET") != nullptr)
      sets_.push_back({{keyword, {}, in_part_, level_}, first, content.node_tags.size()});
  }

  void take_elements(const DeckKeyword& keyword) {
    const std::string* type = keyword.parameter("TYPE");
    if (type == nullptr) in_.fail(keyword.place, keyword.shown + ": expected TYPE=<type of element>");
    const std::string upper = upper_case(*type);
    const auto known = deck_element_type(upper);
    if (!known)
      in_.fail(keyword.place, "elements of the type " + in_.quoted(keyword.place, *type) +
                                  " are not supported: " + std::string(why_not_known(upper)));
    std::size_t cell = 0;
    while (cells()[cell].name != known->cell) ++cell;
    const std::size_t first = deck_.element_tags.size(),
                      count = static_cast<std::size_t>(cells()[cell].nodes) + 1;
    std::array<std::int64_t, most_fields> values{};
    for (DeckRow row; in_.data(row);) {
      const DeckPlace place = row.place;
      std::size_t there = 0;
      for (bool more = true; more;) {
        for (std::size_t f = 0; f < row.fields.size(); ++f) {
          if (there == count)
            in_.fail(row.place,
                     "expected " + std::to_string(count - 1) + " nodes of a " + upper + ", got more");
          values[there++] = number(row, f, "the number of a node or element");
        }
        more = there < count;
        if (more && !in_.data(row))
          in_.fail(place, "expected " + std::to_string(count - 1) + " nodes of a " + upper + ", got " +
                              std::to_string(there - 1));
      }
      add_element(place, cell, {values.data(), count});
    }
    types_.push_back({*known, upper, keyword.place, cell});
    if (keyword.parameter("ELSET") != nullptr)
      sets_.push_back({{keyword, {}, in_part_, level_}, first, deck_.element_tags.size()});
  }

  void add_element(DeckPlace place, std::size_t cell, std::span<const std::int64_t> values) {
    if (deck_.elements.size() >= std::numeric_limits<std::int32_t>::max())
      in_.fail(place, "more elements than 32-bit indices can number");
    if (values[0] <= 0)
      in_.fail(place, "expected a positive number of an element, got " + std::to_string(values[0]));
    ElementList& list = deck_.content.elements[cell];
    deck_.elements.push_back({static_cast<std::int32_t>(cell), static_cast<std::int32_t>(list.count())});
    deck_.element_tags.push_back(values[0]);
    list.tags.push_back(values[0]);
    raw_nodes_.insert(raw_nodes_.end(), values.begin() + 1, values.end());
    element_places_.push_back(place);
  }

  /// Index of the second occurrence of a duplicate number.
  static std::size_t second(const std::vector<std::int64_t>& tags, std::int64_t twice) {
    const auto first = std::find(tags.begin(), tags.end(), twice);
    return static_cast<std::size_t>(std::find(first + 1, tags.end(), twice) - tags.begin());
  }

  void number_nodes() {
    if (const auto twice = deck_.node_index.assign(deck_.content.node_tags))
      in_.fail(node_places_[second(deck_.content.node_tags, *twice)],
               "node " + std::to_string(*twice) + " is there twice");
    if (const auto twice = deck_.element_index.assign(deck_.element_tags))
      in_.fail(element_places_[second(deck_.element_tags, *twice)],
               "element " + std::to_string(*twice) + " is there twice");
  }

  void place_elements() {
    std::size_t next = 0;
    for (std::size_t e = 0; e < deck_.elements.size(); ++e) {
      const Cell& cell = cells()[deck_.elements[e].cell];
      std::vector<std::int32_t>& nodes = deck_.content.elements[deck_.elements[e].cell].nodes;
      const std::size_t first = nodes.size(), count = cell.nodes;
      nodes.resize(first + count);
      for (std::size_t k = 0; k < count; ++k) {
        const std::int64_t tag = raw_nodes_[next++];
        const std::int32_t node = deck_.node_index.find(tag);
        if (node < 0)
          in_.fail(element_places_[e], "element " + std::to_string(deck_.element_tags[e]) +
                                           " refers to node " + std::to_string(tag) +
                                           ", which no *NODE gives");
        // Mid-edge nodes of tetrahedra are in VTK's order.
        nodes[first + (cell.vtk_order.empty() ? k : cell.vtk_order[k])] = node;
      }
    }
    check_types();
  }

  /// Checks that the element types of the body are supported, and adds their remarks as warnings.
  void check_types() {
    int dim = 0;
    for (const Type& type : types_) dim = std::max(dim, cells()[type.cell].dim);
    const Type* first = nullptr;
    for (const Type& type : types_) {
      if (cells()[type.cell].dim < dim) continue;
      if (!type.known.refusal.empty())
        in_.fail(type.place, "a body of " + type.name + ": " + std::string(type.known.refusal));
      if (!type.known.remark.empty())
        deck_.warnings.push_back(deck_.place_text(type.place) + ": " + type.name + ": " +
                                 std::string(type.known.remark));
      if (first == nullptr) first = &type;
      if (type.known.plane != first->known.plane)
        in_.fail(type.place,
                 "a body of " + type.name + " beside " + first->name +
                     ": expected one of plane strain (CPE), plane stress (CPS), axial symmetry (CAX)");
      deck_.plane = type.known.plane;
    }
  }

  struct Type {
    DeckElementType known;
    std::string name;
    DeckPlace place;
    std::size_t cell;
  };

  DeckLines in_;
  Deck deck_;
  std::vector<DeckSetSource> sets_;
  std::vector<Type> types_;
  std::vector<DeckPlace> node_places_, element_places_;
  std::vector<std::int64_t> raw_nodes_;
  bool in_part_ = false, have_part_ = false, have_instance_ = false;
  std::string part_;  ///< its name in upper case
  DeckLevel level_ = DeckLevel::model;
};

}  // namespace

Deck read_deck(const SourceFile& source) {
  std::vector<std::shared_ptr<const MappedFile>> mapped;
  std::vector<std::shared_ptr<const void>> bytes;
  const auto open = [&](const std::string& name) {
    mapped.push_back(std::make_shared<const MappedFile>(name));
    const auto text = std::make_shared<const TextBytes>(name, mapped.back()->bytes());
    bytes.insert(bytes.end(), {mapped.back(), text});
    return text->text();
  };
  const auto check = [&] {
    for (const auto& file : mapped) file->check_unchanged();
  };
  try {
    Deck deck = Reader(source, open(source.path), open).read();
    check();
    deck.bytes = std::move(bytes);
    return deck;
  } catch (const InputError&) {
    check();
    throw;
  }
}

Deck read_deck(const SourceFile& name, std::string_view bytes) {
  const auto text = std::make_shared<const TextBytes>(name.path, bytes);
  const auto open = [](const std::string&) -> std::string_view {
    throw InputError("files cannot be included here");
  };
  Deck deck = Reader(name, text->text(), open).read();
  deck.bytes.push_back(text);
  return deck;
}

}  // namespace kacanov
