// SPDX-License-Identifier: BSD-3-Clause
// What a SIMD lane works on: a fan of tetrahedra round an edge, or one element.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>
#include "simd/block.hpp"

namespace kacanov {

/// A number of the mesh as an index.
constexpr std::size_t at(std::int32_t i) noexcept { return static_cast<std::size_t>(i); }

struct Unit {
  simd::Shape shape;
  std::uint8_t length;  ///< tetrahedra of a fan, 1 for an element
  std::uint16_t law;
  std::uint32_t first_node;     ///< in Units::nodes
  std::uint32_t first_element;  ///< in Units::elements
};

/// Nodes of a fan: p, q, then the ring; its elements in ring order. Element i of a fan is the
/// tetrahedron (p, q, ring i, ring i+1). Fans of tet10 are all open and have their middles between, see
/// simd/tet10.hpp; a ring that closes has its beginning again at its end.
struct Units {
  ElementType type = ElementType::tet4;
  std::vector<Unit> units;
  std::vector<std::int32_t> nodes, elements;

  /// Nodes and points a unit of this shape and length has.
  std::uint32_t nodes_of(simd::Shape shape, std::uint32_t length) const;
  std::uint32_t points_of(simd::Shape shape, std::uint32_t length) const;
  /// Which of a unit's nodes is node a of its element i, as its points count the element's corners.
  std::uint32_t node_of(simd::Shape shape, std::uint32_t length, std::uint32_t i, std::uint32_t a) const;
  /// Whether the loops read where node k of a unit of this shape is. Straight sides need no middles.
  bool is_placed(simd::Shape shape, std::uint32_t k) const {
    return type != ElementType::tet10 || shape == simd::Shape::general || k < 2 || k % 4 == 3;
  }
  std::uint32_t node_count(std::uint32_t unit) const {
    return nodes_of(units[unit].shape, units[unit].length);
  }
  const std::int32_t* nodes_begin(std::uint32_t unit) const { return nodes.data() + units[unit].first_node; }
};

/// Covers a body by units of one law each. tet4, and tet10 with straight sides (mid-side nodes within 1e-13
/// of the middle, relative to the side): greedily, the edge with most tetrahedra left first; what is left
/// round it is split into chains. Other elements: one by one; a hex8 that is a parallelepiped (corners within
/// 1e-13 of its extent along each axis) is a shape of its own.
Units make_units(const Body& body);

}  // namespace kacanov
