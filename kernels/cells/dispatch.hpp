// SPDX-License-Identifier: BSD-3-Clause
// From the element type known at run time to the element's struct.
#pragma once

#include <stdexcept>

#include <kacanov/mesh_view.hpp>
#include "cells/hex8.hpp"
#include "cells/tet10.hpp"
#include "cells/tet4.hpp"
#include "cells/tri3.hpp"

namespace kacanov::elements {

/// Calls `function(E{})` with the struct of `type`.
template <class Function>
decltype(auto) dispatch(ElementType type, Function&& function) {
  switch (type) {
    case ElementType::tri3: return function(Tri3{});
    case ElementType::tet4: return function(Tet4{});
    case ElementType::tet10: return function(Tet10{});
    case ElementType::hex8: return function(Hex8{});
  }
  throw std::invalid_argument("unknown element type");
}

}  // namespace kacanov::elements
