// SPDX-License-Identifier: BSD-3-Clause
// Reads a file of nodal temperatures.
#pragma once

#include "verify/mesh.hpp"

namespace kacanov::verify {

/// Reads the CSV file of an object with `otherwise` (user guide: temperature); returns one value per node.
std::vector<Real> read_node_values(const std::filesystem::path& file, const nlohmann::json& given,
                                   const Mesh& mesh);

}  // namespace kacanov::verify
