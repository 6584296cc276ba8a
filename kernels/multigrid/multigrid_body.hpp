// SPDX-License-Identifier: BSD-3-Clause
// A body, or a rank's part of one, as the multigrid sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <kacanov/index_map.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// Elements are split over the ranks without overlap; vectors are consistent: every copy of a shared entry
/// holds the same bits. All that is pointed to has to outlive who uses it.
struct MultigridBody {
  Body body;
  const IndexMap* node_map = nullptr;  ///< of the nodes
  std::span<const std::uint8_t> held;  ///< nodes × dim: components that are zero
  /// An operator of this mesh and its laws of elements, or null: how it divides them is taken over, at once
  /// or, in 3D, in some build.
  const Operator* like = nullptr;

  std::size_t dim() const noexcept { return dimension(body.mesh.type); }
  std::size_t nodes() const noexcept { return body.mesh.node_count(); }
  std::size_t unknowns() const noexcept { return body.mesh.coordinates.size(); }
  std::size_t owned_nodes() const noexcept { return node_map->owned; }
  std::size_t owned_unknowns() const noexcept { return owned_nodes() * dim(); }
};

}  // namespace kacanov
