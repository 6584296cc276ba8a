// SPDX-License-Identifier: BSD-3-Clause
// Work items of a SIMD lane: a fan of tetrahedra around an edge, or one element.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>
#include "simd/block.hpp"

namespace kacanov {

/// Converts a number of the mesh to an index.
constexpr std::size_t at(std::int32_t i) noexcept { return static_cast<std::size_t>(i); }

struct WorkItem {
  simd::Shape shape;
  std::uint8_t length;  ///< number of tetrahedra of a fan; 1 for an element
  std::uint16_t law;
  std::uint32_t first_node;     ///< index into WorkItems::nodes
  std::uint32_t first_element;  ///< index into WorkItems::elements
};

/// Nodes of a fan: p, q, then the ring; its elements in ring order. Element i of a fan is the tetrahedron (p,
/// q, ring i, ring i+1). Fans of tet10 are always open, with their mid-side nodes in between, see
/// simd/tet10.hpp; a closed ring repeats its first node at the end.
struct WorkItems {
  ElementType type = ElementType::tet4;
  std::vector<WorkItem> list;
  std::vector<std::int32_t> nodes, elements;

  /// Number of nodes and points of an item with this shape and length.
  std::uint32_t nodes_of(simd::Shape shape, std::uint32_t length) const;
  std::uint32_t points_of(simd::Shape shape, std::uint32_t length) const;
  /// Index in the item of node a of its element i, in the corner order of the element's points.
  std::uint32_t node_of(simd::Shape shape, std::uint32_t length, std::uint32_t i, std::uint32_t a) const;
  /// Whether the loops read the coordinates of node k; with straight edges they skip mid-side nodes.
  bool is_placed(simd::Shape shape, std::uint32_t k) const {
    return type != ElementType::tet10 || shape == simd::Shape::general || k < 2 || k % 4 == 3;
  }
  std::uint32_t node_count(std::uint32_t item) const { return nodes_of(list[item].shape, list[item].length); }
  const std::int32_t* nodes_begin(std::uint32_t item) const { return nodes.data() + list[item].first_node; }
};

/// Covers a body by work items of one law each. tet4, and tet10 with straight edges (mid-side nodes within
/// 1e-13 of the midpoint, relative to the edge length): greedily, first the edge with most uncovered
/// tetrahedra around it, which are split into chains. Other elements: one by one; a hex8 that is a
/// parallelepiped (corners within 1e-13 of its extent along each axis) has its own shape.
WorkItems make_work_items(const Body& body);

/// Each element that is not in `left_out` is in exactly one fan; the elements of a fan share one law.
WorkItems cover_by_fans(const Body& body, std::vector<bool> left_out);

}  // namespace kacanov
