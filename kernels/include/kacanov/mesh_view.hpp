// SPDX-License-Identifier: BSD-3-Clause
// Element types and a non-owning view of a mesh: what the kernels know of geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kacanov {

/// Volume elements. Node order is that of Gmsh (tet10: edges 01 12 20 30 32 31).
enum class ElementType : std::uint8_t { tri3, tet4, tet10, hex8 };

/// Space dimension of an element: 2 (plane strain) or 3.
constexpr int dimension(ElementType type) noexcept { return type == ElementType::tri3 ? 2 : 3; }

constexpr int nodes_per_element(ElementType type) noexcept {
  switch (type) {
    case ElementType::tri3: return 3;
    case ElementType::tet4: return 4;
    case ElementType::tet10: return 10;
    case ElementType::hex8: return 8;
  }
  return 0;
}

/// Quadrature points at which the secant modulus g is kept: one value each.
constexpr int points_per_element(ElementType type) noexcept {
  switch (type) {
    case ElementType::tri3: return 1;
    case ElementType::tet4: return 1;
    case ElementType::tet10: return 4;
    case ElementType::hex8: return 8;
  }
  return 0;
}

/// Arrays of the caller, which must outlive the view.
struct MeshView {
  ElementType type = ElementType::tet4;
  std::span<const double> coordinates;         ///< nodes × dim, interleaved
  std::span<const std::int32_t> connectivity;  ///< elements × nodes_per_element, from 0

  std::size_t node_count() const noexcept {
    return coordinates.size() / static_cast<std::size_t>(dimension(type));
  }
  std::size_t element_count() const noexcept {
    return connectivity.size() / static_cast<std::size_t>(nodes_per_element(type));
  }
};

}  // namespace kacanov
