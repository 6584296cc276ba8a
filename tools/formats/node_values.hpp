// SPDX-License-Identifier: BSD-3-Clause
// Numbers at the nodes of a mesh, as temperatures, from a CSV file.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// One number a node of `mesh`. `bytes` is the whole file, `source` its name in messages: a line each of the
/// number of a node, or the name of a group, whose nodes are meant, and a value, between them a comma, a
/// semicolon or blanks; a later line takes the place of an earlier one, and those that begin with # or ** do
/// not count. Nodes of which none speaks have `otherwise`, or NaN. Nodes in the middle of edges have the mean
/// of the edge's ends, whatever the file says. Lines of nodes that the mesh does not have give a warning of
/// the mesh. Throws InputError naming the line of what is wrong.
std::vector<double> parse_node_values(const SourceFile& source, std::string_view bytes,
                                      std::optional<double> otherwise, Mesh& mesh);
std::vector<double> read_node_values(const SourceFile& source, std::optional<double> otherwise, Mesh& mesh);

}  // namespace kacanov
