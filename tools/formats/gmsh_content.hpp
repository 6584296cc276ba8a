// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's element numbers and their names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace kacanov {

/// The cell with this number in Gmsh among cells(), the element types that can be a body or a part of its
/// boundary; nothing for others.
std::optional<std::size_t> gmsh_cell(std::int64_t type);
/// Name of an element type of Gmsh, supported or not; empty for an unknown one.
std::string_view gmsh_type_name(std::int64_t type);

}  // namespace kacanov
