// SPDX-License-Identifier: BSD-3-Clause
// A body, or a rank's part of one, as input of the multigrid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <kacanov/index_map.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/reference.hpp>

namespace kacanov {

/// Elements are distributed over the ranks without overlap; vectors are consistent: every copy of a shared
/// entry has the same bits. All arrays must outlive their users.
struct MultigridBody {
  Body body;
  const IndexMap* node_map = nullptr;  ///< index map of the nodes
  std::span<const std::uint8_t> held;  ///< nodes × dim: nonzero for components held at zero
  /// An operator of this mesh and law_of_element, or null: its partitioning is reused, immediately or, in 3D,
  /// in a later build.
  const Operator* like = nullptr;

  std::size_t dim() const noexcept { return dimension(body.mesh.type); }
  std::size_t nodes() const noexcept { return body.mesh.node_count(); }
  std::size_t unknowns() const noexcept { return body.mesh.coordinates.size(); }
  std::size_t owned_nodes() const noexcept { return node_map->owned; }
  std::size_t owned_unknowns() const noexcept { return owned_nodes() * dim(); }
};

}  // namespace kacanov
