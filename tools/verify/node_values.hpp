// SPDX-License-Identifier: BSD-3-Clause
// A file of temperatures at nodes.
#pragma once

#include "verify/mesh.hpp"

namespace kacanov::verify {

/// Of the CSV file of an object with `otherwise` (user guide: temperature), one a node.
std::vector<Real> read_node_values(const std::filesystem::path& file, const nlohmann::json& given,
                                   const Mesh& mesh);

}  // namespace kacanov::verify
