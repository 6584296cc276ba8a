// SPDX-License-Identifier: BSD-3-Clause
// The loops over a body's elements that its fields come from.
#include "field_loops.hpp"

namespace kacanov {
namespace {

constexpr FieldLoops plain_loops{reference::fields, reference::point_fields, reference::energy,
                                 reference::volumes};

}  // namespace

const FieldLoops& field_loops(ElementType type) {
  switch (type) {
    case ElementType::tet4: return tet4_loops;
    case ElementType::hex8: return hex8_loops;
    case ElementType::tet10: return tet10_loops;
    default: return plain_loops;
  }
}

}  // namespace kacanov
