// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's element type numbers and names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace kacanov {

/// Returns the index into cells() of a Gmsh element type that can be part of a body or its boundary; nothing
/// for other types.
std::optional<std::size_t> gmsh_cell(std::int64_t type);
/// Returns the name of a Gmsh element type, supported or not; empty if the number is unknown.
std::string_view gmsh_type_name(std::int64_t type);

}  // namespace kacanov
