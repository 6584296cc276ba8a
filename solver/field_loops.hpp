// SPDX-License-Identifier: BSD-3-Clause
// The loops over a body's elements that its fields come from.
#pragma once

#include <span>

#include <kacanov/reference.hpp>

namespace kacanov {

/// As the functions of these names in reference, to rounding.
struct FieldLoops {
  void (*fields)(const Body& body, std::span<const double> u, const reference::ElementFields& out);
  void (*point_fields)(const Body& body, std::span<const double> u, const reference::PointFields& out);
  double (*energy)(const Body& body, std::span<const double> u);
  void (*volumes)(const Body& body, std::span<double> volume);
};

/// Some elements abreast; Body::moduli is taken to be null.
extern const FieldLoops tet4_loops, hex8_loops, tet10_loops;

/// The fastest there are: the reference's for a type that has none of its own.
const FieldLoops& field_loops(ElementType type);

}  // namespace kacanov
