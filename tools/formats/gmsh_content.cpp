// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's element type numbers and names.
#include "formats/gmsh_content.hpp"

#include <kacanov/cells.hpp>

namespace kacanov {

std::string_view gmsh_type_name(std::int64_t type) {
  if (const auto known = gmsh_cell(type)) return cells()[*known].name;
  switch (type) {  // unsupported types
    case 6: return "prism6";
    case 7: return "pyramid5";
    case 10: return "quad9";
    case 12: return "hex27";
    case 13: return "prism18";
    case 14: return "pyramid14";
    case 16: return "quad8";
    case 17: return "hex20";
    case 18: return "prism15";
    case 19: return "pyramid13";
    case 20: return "tri9";
    case 21: return "tri10";
    case 22: return "tri12";
    case 23:
    case 24: return "tri15";
    case 25: return "tri21";
    case 26: return "line4";
    case 27: return "line5";
    case 28: return "line6";
    case 29: return "tet20";
    case 30: return "tet35";
    case 31: return "tet56";
    default: return {};
  }
}

std::optional<std::size_t> gmsh_cell(std::int64_t type) {
  for (std::size_t c = 0; c < cells().size(); ++c)
    if (cells()[c].gmsh == type) return c;
  return std::nullopt;
}

}  // namespace kacanov
