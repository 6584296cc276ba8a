// SPDX-License-Identifier: BSD-3-Clause
// The list of element types, and the dispatch from a run-time type to its struct.
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>

#include "cells/hex8.hpp"
#include "cells/tet10.hpp"
#include "cells/tet4.hpp"
#include "cells/tri3.hpp"

namespace kacanov::elements {

/// Cells of bodies, in the order of ElementType.
using Bodies = std::tuple<Tri3, Tet4, Tet10, Hex8, Quad4>;
/// Other cells in mesh files.
using Others = std::tuple<Point1, Line2, Line3, Tri6>;

/// Calls `function(E{})` with the struct of `type`. Throws std::invalid_argument for an invalid number.
template <std::size_t i = 0, class Function>
decltype(auto) dispatch(ElementType type, Function&& function) {
  using E = std::tuple_element_t<i, Bodies>;
  static_assert(E::type == static_cast<ElementType>(i), "Bodies and ElementType differ in their order");
  if constexpr (i + 1 < std::tuple_size_v<Bodies>) {
    if (type != E::type) return dispatch<i + 1>(type, std::forward<Function>(function));
  } else if (type != E::type) {
    cell_table::refuse(type);
  }
  return function(E{});
}

}  // namespace kacanov::elements
