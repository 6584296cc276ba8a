// SPDX-License-Identifier: BSD-3-Clause
// Parses the sections of a Gmsh file, each in both versions.
#include "formats/gmsh_parser.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>

#include <kacanov/error.hpp>
#include "formats/gmsh_content.hpp"
#include "formats/gmsh_cursor.hpp"
#include "formats/node_index.hpp"

namespace kacanov {
namespace {

/// Limit per element, because every combination of groups that occurs is stored.
constexpr std::int64_t most_groups = 256;

class Parser {
 public:
  Parser(const SourceFile& source, std::string_view bytes) : in_(source, bytes) {}

  MeshContent parse() {
    format();
    while (in_.skip_blank_lines()) {
      const std::string_view line = in_.line();
      if (line.empty() || line[0] != '$')
        in_.fail("expected a section such as $Nodes, got " + in_.quoted(line));
      section(std::string(line.substr(1)));
    }
    if (!have_nodes_) in_.fail("the file ends without a $Nodes section");
    if (!have_elements_) in_.fail("the file ends without an $Elements section");
    return std::move(content_);
  }

 private:
  void format() {
    const char* expected = "expected $MeshFormat: is this a Gmsh mesh?";
    if (!in_.skip_blank_lines()) in_.fail(expected);
    std::string_view line = in_.line();
    while (line == "$Comments") {
      in_.skip_section("Comments");
      in_.skip_blank_lines();
      line = in_.line();
    }
    if (line == "$NOD") in_.fail("Gmsh's format 1 is not supported: only 2.2 and 4.1 are");
    if (line != "$MeshFormat") in_.fail(expected);
    const double version = in_.text_real("format version");
    if (version != 2.2 && version != 4.1) {
      std::string text = std::to_string(version);
      text.erase(text.find_last_not_of('0') + 1);
      in_.fail("format version " + text + (text.back() == '.' ? "0" : "") +
               " is not supported: only 2.2 and 4.1 are (gmsh -format msh22 or msh41)");
    }
    new_format_ = version == 4.1;
    const std::int64_t encoding = in_.text_integer("file type");
    if (encoding != 0 && encoding != 1) in_.fail("file type: expected 0 (ASCII) or 1 (binary)");
    if (in_.text_integer("data size") != 8) in_.fail("data size: only 8 is supported");
    in_.text_end_of_line();
    if (encoding == 1) {
      in_.set_binary();
      const std::int32_t one = in_.tag("the number 1 that shows the byte order");
      if (one == 0x01000000)
        in_.fail("the file was written with the other byte order, which is not supported");
      if (one != 1) in_.fail("the number 1 that shows the byte order is missing: corrupt");
    }
    in_.end_section("MeshFormat");
  }

  void section(const std::string& name) {
    if (name == "PhysicalNames") {
      physical_names();
    } else if (name == "Entities" && new_format_) {
      once(have_entities_, name);
      entities();
    } else if (name == "PartitionedEntities") {
      in_.fail("partitioned meshes are not supported: save the mesh unpartitioned");
    } else if (name == "Nodes") {
      once(have_nodes_, name);
      new_format_ ? node_blocks() : node_list();
    } else if (name == "Elements") {
      once(have_elements_, name);
      if (!have_nodes_) in_.fail("$Elements comes before $Nodes");
      new_format_ ? element_blocks() : element_list();
    } else if (name.starts_with("End")) {
      in_.fail(in_.quoted("$" + name) + " without its beginning");
    } else {
      in_.skip_section(name);
      return;
    }
    in_.end_section(name);
  }

  void once(bool& have, const std::string& name) {
    if (have) in_.fail("a second $" + name + " section");
    have = true;
  }

  void physical_names() {
    const std::int64_t count = in_.text_integer("number of physical names");
    in_.expect_room(count, 4, "physical names");
    in_.text_end_of_line();
    for (std::int64_t i = 0; i < count; ++i) {
      in_.skip_blank_lines();
      const std::int64_t dimension = in_.text_integer("dimension of a physical group");
      if (dimension < 0 || dimension > 3) in_.fail("dimension of a physical group: expected 0 to 3");
      const std::int64_t tag = in_.text_integer("number of a physical group");
      constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
      if (tag > most || tag < -most) in_.fail("number of a physical group: out of range");
      const std::string_view name = in_.text_name("physical group " + std::to_string(tag));
      const auto key = std::pair(static_cast<int>(dimension), static_cast<int>(std::abs(tag)));
      if (!content_.names.emplace(key, name).second)
        in_.fail("physical group " + std::to_string(tag) + " of dimension " + std::to_string(dimension) +
                 " is named twice");
    }
  }

  // Format 4.1: entities have the physical groups.

  void entities() {
    std::array<std::int64_t, 4> counts{};
    for (auto& count : counts) {
      count = in_.size("number of entities");
      in_.expect_room(count, 8, "entities");
    }
    in_.end_record();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t i = 0; i < counts[dimension]; ++i) entity(dimension);
  }

  void entity(int dimension) {
    const int tag = in_.tag("number of an entity");
    for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) in_.real("bounding box of an entity");
    const std::int64_t count = in_.size("number of physical groups of an entity");
    in_.expect_room(count, 2, "physical groups");
    if (count > most_groups) refuse_groups("entity", tag);
    std::vector<int> physicals;
    for (std::int64_t k = 0; k < count; ++k)
      physicals.push_back(physical(in_.tag("number of a physical group")));
    if (dimension > 0) {
      const std::int64_t bounding = in_.size("number of bounding entities");
      in_.expect_room(bounding, 2, "bounding entities");
      for (std::int64_t k = 0; k < bounding; ++k) in_.tag("number of a bounding entity");
    }
    in_.end_record();
    if (!entities_.emplace(std::pair(dimension, tag), set_of(std::move(physicals))).second)
      in_.fail("entity " + std::to_string(tag) + " of dimension " + std::to_string(dimension) +
               " is listed twice");
  }

  /// A minus sign marks reversed orientation in Gmsh.
  int physical(std::int32_t tag) {
    if (tag == std::numeric_limits<std::int32_t>::min()) in_.fail("number of a physical group: out of range");
    return std::abs(tag);
  }

  std::size_t set_of(std::vector<int> physicals) {
    std::sort(physicals.begin(), physicals.end());
    physicals.erase(std::unique(physicals.begin(), physicals.end()), physicals.end());
    const auto [place, added] = sets_.emplace(physicals, content_.physicals.size());
    if (added) content_.physicals.push_back(std::move(physicals));
    return place->second;
  }

  void node_blocks() {
    const std::int64_t blocks = in_.size("number of node blocks");
    const std::int64_t total = in_.size("number of nodes");
    reserve_nodes(total);
    in_.size("smallest node number");
    in_.size("largest node number");
    in_.end_record();
    for (std::int64_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = in_.tag("dimension of an entity");
      if (dimension < 0 || dimension > 3) in_.fail("dimension of an entity: expected 0 to 3");
      in_.tag("number of an entity");
      const std::int32_t parametric = in_.tag("parametric flag");
      if (parametric != 0 && parametric != 1) in_.fail("parametric flag: expected 0 or 1");
      const std::int64_t count = in_.size("number of nodes in a block");
      if (count > total - static_cast<std::int64_t>(content_.node_tags.size()))
        in_.fail("the node blocks have more than the " + std::to_string(total) + " nodes announced");
      in_.end_record();
      for (std::int64_t i = 0; i < count; ++i) {
        node_tag(in_.size("number of a node"));
        in_.end_record();
      }
      for (std::int64_t i = 0; i < count; ++i) {
        position();
        for (int k = 0; k < parametric * dimension; ++k) in_.real("parameter of a node");
        in_.end_record();
      }
    }
    finish_nodes(total);
  }

  void node_list() {
    const std::int64_t total = in_.text_integer("number of nodes");
    reserve_nodes(total);
    in_.text_end_of_line();
    for (std::int64_t i = 0; i < total; ++i) {
      node_tag(in_.tag("number of a node"));
      position();
      in_.end_record();
    }
    finish_nodes(total);
  }

  void reserve_nodes(std::int64_t total) {
    in_.expect_room(total, 8, "nodes");
    if (total > std::numeric_limits<std::int32_t>::max() / 3)
      in_.fail(std::to_string(total) + " nodes are more than 32-bit indices can number");
    content_.node_tags.reserve(total);
    content_.coordinates.reserve(3 * static_cast<std::size_t>(total));
  }

  void node_tag(std::int64_t tag) {
    if (tag <= 0) in_.fail("number of a node: expected a positive number, got " + std::to_string(tag));
    content_.node_tags.push_back(tag);
  }

  void position() {
    content_.coordinates.push_back(in_.real("x coordinate"));
    content_.coordinates.push_back(in_.real("y coordinate"));
    content_.coordinates.push_back(in_.real("z coordinate"));
  }

  void finish_nodes(std::int64_t total) {
    if (static_cast<std::int64_t>(content_.node_tags.size()) != total)
      in_.fail(std::to_string(total) + " nodes announced, but the blocks have " +
               std::to_string(content_.node_tags.size()));
    if (const auto twice = index_.assign(content_.node_tags))
      in_.fail("node " + std::to_string(*twice) + " is listed twice");
  }

  void element_blocks() {
    const std::int64_t blocks = in_.size("number of element blocks");
    const std::int64_t total = in_.size("number of elements");
    in_.expect_room(total, 4, "elements");
    in_.size("smallest element number");
    in_.size("largest element number");
    in_.end_record();
    std::int64_t left = total;
    for (std::int64_t b = 0; b < blocks; ++b) {
      const std::int32_t dimension = in_.tag("dimension of an entity");
      const std::int32_t entity = in_.tag("number of an entity");
      const std::int32_t type = in_.tag("element type");
      const auto shape = gmsh_cell(type);
      if (shape && cells()[*shape].dim != dimension)
        in_.fail("elements of type " + std::to_string(type) + " in an entity of dimension " +
                 std::to_string(dimension));
      const std::int64_t count = in_.size("number of elements in a block");
      if (count > left)
        in_.fail("the element blocks have more than the " + std::to_string(total) + " elements announced");
      left -= count;
      in_.end_record();
      if (count == 0) continue;
      if (!shape) refuse_type(type, in_.size("number of an element"));
      const std::size_t set = entity_set(dimension, entity);
      reserve_elements(*shape, count);
      for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t tag = in_.size("number of an element");
        nodes(*shape, tag, [&] { return in_.size("node of an element"); });
        add(*shape, tag, set);
        in_.end_record();
      }
    }
    if (left != 0) in_.fail(std::to_string(left) + " of the elements announced are missing");
  }

  std::size_t entity_set(int dimension, int tag) {
    if (!have_entities_) return 0;
    const auto found = entities_.find({dimension, tag});
    if (found == entities_.end())
      in_.fail("the elements belong to entity " + std::to_string(tag) + " of dimension " +
               std::to_string(dimension) + ", which $Entities does not list");
    return found->second;
  }

  void element_list() {
    const std::int64_t total = in_.text_integer("number of elements");
    in_.expect_room(total, 8, "elements");
    in_.text_end_of_line();
    for (std::int64_t left = total; left > 0;) {
      if (in_.binary()) {
        const std::int32_t type = in_.tag("element type");
        const std::int32_t count = in_.tag("number of elements in a block");
        if (count < 1 || count > left) in_.fail("number of elements in a block: " + std::to_string(count));
        const std::int32_t tags = in_.tag("number of tags");
        for (std::int32_t i = 0; i < count; ++i) listed_element(in_.tag("number of an element"), type, tags);
        left -= count;
      } else {
        const std::int32_t tag = in_.tag("number of an element");
        const std::int32_t type = in_.tag("element type");
        listed_element(tag, type, in_.tag("number of tags"));
        --left;
      }
    }
  }

  void listed_element(std::int32_t tag, std::int32_t type, std::int32_t tags) {
    const auto shape = gmsh_cell(type);
    if (!shape) refuse_type(type, tag);
    if (tags < 0) in_.fail("number of tags: expected a number ≥ 0, got " + std::to_string(tags));
    int group = 0;
    for (std::int32_t k = 0; k < tags; ++k) {
      const std::int32_t value = in_.tag("tag of an element");
      if (k == 0) group = physical(value);
    }
    nodes(*shape, tag, [&] { return in_.tag("node of an element"); });
    in_.end_record();
    if (group != last_group_) {
      last_group_ = group;
      last_set_ = group == 0 ? 0 : set_of({group});
    }
    const std::size_t set = last_set_;
    if (!repeats_last(*shape)) {
      add(*shape, tag, set);
      return;
    }
    // In format 2.2 Gmsh writes an element with several physical groups once per group, consecutively.
    ElementList& list = content_.elements[*shape];
    list.nodes.resize(list.nodes.size() - static_cast<std::size_t>(cells()[*shape].nodes));
    std::vector<int> both = content_.physicals[list.runs.back().set];
    if (both.size() >= std::size_t{most_groups}) refuse_groups("element", tag);
    if (group != 0) both.push_back(group);
    list.assign_last(set_of(std::move(both)));
  }

  bool repeats_last(std::size_t shape) {
    const ElementList& list = content_.elements[shape];
    const auto n = static_cast<std::ptrdiff_t>(cells()[shape].nodes);
    return list.count() > 0 && std::equal(list.nodes.end() - n, list.nodes.end(), list.nodes.end() - 2 * n);
  }

  // Used by both formats.

  [[noreturn]] void refuse_groups(const char* what, std::int64_t tag) const {
    in_.fail(what + (" " + std::to_string(tag)) + " belongs to more than " + std::to_string(most_groups) +
             " physical groups");
  }

  [[noreturn]] void refuse_type(std::int64_t type, std::int64_t tag) const {
    const std::string name(gmsh_type_name(type));
    in_.fail("element " + std::to_string(tag) + " is of Gmsh's type " + std::to_string(type) +
             (name.empty() ? name : " (" + name + ")") + ", which is not supported: bodies are made of " +
             element_names([](const Cell&) { return true; }));
  }

  void reserve_elements(std::size_t shape, std::int64_t count) {
    in_.expect_room(count, 4, "elements");
    ElementList& list = content_.elements[shape];
    const std::size_t needed = list.count() + static_cast<std::size_t>(count);
    if (needed <= list.tags.capacity()) return;
    const std::size_t capacity = std::max(needed, list.count() + list.count() / 2);
    list.tags.reserve(capacity);
    list.nodes.reserve(capacity * static_cast<std::size_t>(cells()[shape].nodes));
  }

  template <typename Next>
  void nodes(std::size_t shape, std::int64_t element, Next&& next) {
    auto& list = content_.elements[shape].nodes;
    for (int k = 0; k < cells()[shape].nodes; ++k) {
      const std::int64_t tag = next();
      const std::int32_t node = index_.find(tag);
      if (node < 0)
        in_.fail("element " + std::to_string(element) + " refers to node " + std::to_string(tag) +
                 ", which $Nodes does not list");
      list.push_back(node);
    }
  }

  void add(std::size_t shape, std::int64_t tag, std::size_t set) {
    ElementList& list = content_.elements[shape];
    if (list.count() >= std::numeric_limits<std::int32_t>::max())
      in_.fail("more elements than 32-bit indices can number");
    list.tags.push_back(tag);
    list.assign_last(set);
  }

  GmshCursor in_;
  MeshContent content_;
  NodeIndex index_;
  std::map<std::pair<int, int>, std::size_t> entities_;  // group set by (dimension, number)
  std::map<std::vector<int>, std::size_t> sets_{{{}, 0}};
  int last_group_ = 0;  // format 2.2: group of the previous element, and its set; often the same again
  std::size_t last_set_ = 0;
  bool new_format_ = false;
  bool have_entities_ = false, have_nodes_ = false, have_elements_ = false;
};

}  // namespace

MeshContent parse_gmsh(const SourceFile& source, std::string_view bytes) {
  return Parser(source, bytes).parse();
}

}  // namespace kacanov
