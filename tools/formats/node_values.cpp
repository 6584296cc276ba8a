// SPDX-License-Identifier: BSD-3-Clause
// Reads nodal values, such as temperatures, from a CSV file.
#include "formats/node_values.hpp"

#include <charconv>
#include <limits>
#include <map>
#include <numeric>

#include <kacanov/cells.hpp>
#include <kacanov/error.hpp>
#include "formats/mapped_file.hpp"
#include "formats/node_index.hpp"
#include "formats/text_bytes.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

std::vector<std::int32_t> nodes_of_group(const Mesh& mesh, const Group& group) {
  const auto dim = static_cast<std::size_t>(mesh.dim());
  const auto dimension = static_cast<std::size_t>(group.dimension);
  if (dimension + 1 < dim) return group.members;
  const std::size_t each = dimension == dim ? nodes_per_element(mesh.type) : nodes_per_facet(mesh.type);
  const std::vector<std::int32_t>& cells = dimension == dim ? mesh.elements : mesh.facets;
  std::vector<std::int32_t> nodes;
  for (const std::size_t cell : group.members)
    nodes.insert(nodes.end(), cells.begin() + static_cast<std::ptrdiff_t>(cell * each),
                 cells.begin() + static_cast<std::ptrdiff_t>((cell + 1) * each));
  return nodes;
}

class NodeValueText {
 public:
  NodeValueText(const SourceFile& source, Mesh& mesh, std::optional<double> otherwise)
      : source_(source),
        mesh_(mesh),
        values_(mesh.node_count(), otherwise.value_or(std::numeric_limits<double>::quiet_NaN())) {
    std::vector<std::int64_t> tags = mesh.node_tags;
    if (tags.empty()) {
      tags.resize(mesh.node_count());
      std::iota(tags.begin(), tags.end(), std::int64_t{1});
    }
    nodes_.assign(tags);
    for (const Group& group : mesh.groups) groups_[group.name].push_back(&group);
  }

  std::vector<double> parse(std::string_view bytes) {
    const TextBytes whole(source_.path, bytes);
    std::string_view rest = whole.text();
    for (line_ = 1; !rest.empty(); ++line_) {
      const std::string_view text = trimmed(take_line(rest));
      if (!text.empty() && !text.starts_with('#') && !text.starts_with("**")) take(text);
    }
    if (taken_ == 0)
      throw InputError(source_.path + ": expected lines of a node or a group and its value, got none");
    if (unknown_ > 0)
      mesh_.warnings.push_back(source_.path + ": " + std::to_string(unknown_) +
                               " lines are of nodes that are in no element of the mesh; the first is line " +
                               std::to_string(first_unknown_));
    set_middles();
    return std::move(values_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(source_.path + ":" + std::to_string(line_) + ": " + message);
  }

  void take(std::string_view text) {
    std::size_t split = text.find_last_of(",;");
    if (split == std::string_view::npos) split = text.find_last_of(" \t");
    if (split == std::string_view::npos)
      fail("expected a node or a group and its value, got " + source_.quoted(text));
    const std::string_view who = trimmed(text.substr(0, split)), word = trimmed(text.substr(split + 1));
    const std::optional<double> value = to_number(word);
    if (!value) fail("expected a number, got " + source_.quoted(word));
    ++taken_;
    std::int64_t tag = 0;
    const auto read = std::from_chars(who.data(), who.data() + who.size(), tag);
    if (read.ec == std::errc() && read.ptr == who.data() + who.size())
      take_node(tag, *value);
    else
      take_group(who, *value);
  }

  void take_node(std::int64_t tag, double value) {
    const std::int32_t node = nodes_.find(tag);
    if (node >= 0)
      values_[node] = value;
    else if (++unknown_ == 1)
      first_unknown_ = line_;
  }

  void take_group(std::string_view name, double value) {
    const auto found = groups_.find(name);
    if (found == groups_.end())
      fail("expected the number of a node or the name of a group of the mesh, got " + source_.quoted(name));
    for (const Group* group : found->second)
      for (const std::int32_t node : nodes_of_group(mesh_, *group)) values_[node] = value;
  }

  void set_middles() {
    const Cell& type = cell(mesh_.type);
    const std::size_t nodes = type.nodes;
    for (std::size_t e = 0; e < mesh_.element_count(); ++e) {
      const std::int32_t* of = &mesh_.elements[e * nodes];
      for (const CellEdge& edge : type.edges)
        if (edge.middle >= 0) values_[of[edge.middle]] = 0.5 * (values_[of[edge.a]] + values_[of[edge.b]]);
    }
  }

  const SourceFile& source_;
  Mesh& mesh_;
  std::vector<double> values_;
  NodeIndex nodes_;
  std::map<std::string, std::vector<const Group*>, std::less<>> groups_;
  std::int64_t line_ = 1, taken_ = 0, unknown_ = 0, first_unknown_ = 0;
};

}  // namespace

std::vector<double> parse_node_values(const SourceFile& source, std::string_view bytes,
                                      std::optional<double> otherwise, Mesh& mesh) {
  return NodeValueText(source, mesh, otherwise).parse(bytes);
}

std::vector<double> read_node_values(const SourceFile& source, std::optional<double> otherwise, Mesh& mesh) {
  const MappedFile file(source.path);
  std::vector<double> values = parse_node_values(source, file.bytes(), otherwise, mesh);
  file.check_unchanged();
  return values;
}

}  // namespace kacanov
