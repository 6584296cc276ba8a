// SPDX-License-Identifier: BSD-3-Clause
// Reads nodal values, such as temperatures, from a CSV file.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <kacanov/mesh.hpp>
#include "formats/source_file.hpp"

namespace kacanov {

/// Returns one value per node of `mesh`. `bytes` is the whole file; `source` names it in messages. Each line
/// has a node number, or a group name for all nodes of the group, and a value, separated by a comma, a
/// semicolon or blanks. A later line overrides an earlier one; lines that begin with # or ** are skipped.
/// Nodes without a line get `otherwise`, or NaN. Mid-edge nodes get the mean of the edge's end nodes,
/// whatever the file contains. Lines for nodes that are not in the mesh add a warning to the mesh. Throws
/// InputError naming the line of an error.
std::vector<double> parse_node_values(const SourceFile& source, std::string_view bytes,
                                      std::optional<double> otherwise, Mesh& mesh);
std::vector<double> read_node_values(const SourceFile& source, std::optional<double> otherwise, Mesh& mesh);

}  // namespace kacanov
