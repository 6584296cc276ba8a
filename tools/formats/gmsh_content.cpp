// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's element numbers and their names.
#include "formats/gmsh_content.hpp"

namespace kacanov {

const char* gmsh_type_name(std::int64_t type) {
  constexpr std::array<const char*, 32> names{
      nullptr, "line2", "tri3",    "quad4",     "tet4",  "hex8",    "prism6",    "pyramid5",
      "line3", "tri6",  "quad9",   "tet10",     "hex27", "prism18", "pyramid14", "point",
      "quad8", "hex20", "prism15", "pyramid13", "tri9",  "tri10",   "tri12",     "tri15",
      "tri15", "tri21", "line4",   "line5",     "line6", "tet20",   "tet35",     "tet56"};
  return type > 0 && type < static_cast<std::int64_t>(names.size()) ? names[static_cast<std::size_t>(type)]
                                                                    : nullptr;
}

std::optional<GmshShape> gmsh_shape(std::int64_t type) {
  for (std::size_t s = 0; s < gmsh_shape_count; ++s)
    if (gmsh_shapes[s].gmsh_type == type) return static_cast<GmshShape>(s);
  return std::nullopt;
}

void GmshElements::assign_last(std::size_t set) {
  const std::size_t last = count() - 1;
  if (!runs.empty() && runs.back().first == last) runs.pop_back();
  if (runs.empty() || runs.back().set != set) runs.push_back({last, set});
}

}  // namespace kacanov
