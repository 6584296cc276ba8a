// SPDX-License-Identifier: BSD-3-Clause
// Reads a file of nodal temperatures.
#include "verify/node_values.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "verify/file.hpp"

namespace kacanov::verify {
namespace {

std::string without_blanks(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

bool is_whole_number(const std::string& text) {
  const std::size_t digits = text.starts_with("-") ? 1 : 0;
  return text.size() > digits && text.find_first_not_of("0123456789", digits) == std::string::npos;
}

Indices nodes_called(const Mesh& mesh, const std::string& name) {
  Indices nodes;
  for (const NamedGroup& group : mesh.groups) {
    if (group.name != name) continue;
    for (const Indices& cell : group.cells) {
      const Indices& of = group.dimension == mesh.dim() ? mesh.elements[cell[0]] : cell;
      nodes.insert(nodes.end(), of.begin(), of.end());
    }
  }
  return nodes;
}

}  // namespace

std::vector<Real> read_node_values(const std::filesystem::path& file, const nlohmann::json& given,
                                   const Mesh& mesh) {
  const Real unknown = std::numeric_limits<Real>::quiet_NaN();
  std::vector<Real> values(mesh.nodes.size(),
                           given.contains("otherwise") ? Real(given.at("otherwise").get<double>()) : unknown);
  std::map<std::int64_t, Index> index;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    index[mesh.tags.empty() ? static_cast<std::int64_t>(n) + 1 : mesh.tags[n]] = static_cast<Index>(n);
  std::istringstream lines(with_line_feeds(whole(file)));
  for (std::string line; std::getline(lines, line);) {
    line = without_blanks(line);
    if (line.empty() || line.starts_with("#") || line.starts_with("**")) continue;
    std::size_t split = line.find_last_of(",;");
    if (split == std::string::npos) split = line.find_last_of(" \t");
    const std::string who = without_blanks(line.substr(0, split));
    const Real value = std::stod(line.substr(split + 1));
    Indices nodes;
    if (!is_whole_number(who))
      nodes = nodes_called(mesh, who);
    else if (const auto found = index.find(std::stoll(who)); found != index.end())
      nodes = {found->second};
    for (const Index node : nodes) values[node] = value;
  }
  for (std::size_t n = 0; n < mesh.made_of.size(); ++n) {
    if (mesh.made_of[n].empty()) continue;
    values[n] = 0;
    for (const Index parent : mesh.made_of[n])
      values[n] += values[parent] / static_cast<Real>(mesh.made_of[n].size());
  }
  return values;
}

}  // namespace kacanov::verify
