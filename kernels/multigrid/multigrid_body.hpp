// SPDX-License-Identifier: BSD-3-Clause
// Input of the multigrid: a body or a part of one, blocks at nodes, and the constrained space of the solves.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/reference.hpp>
#include <kacanov/vector3.hpp>

namespace kacanov {

/// A dim × dim block added to the diagonal block of a node: a contact penalty, a slip stiffness, or a held
/// direction.
struct NodeBlock {
  std::int32_t node = 0;
  std::array<double, 9> value{};  ///< dim × dim, row-major
};

/// Constraint rows over several nodes.
class HeldRows {
 public:
  virtual ~HeldRows() = default;
  /// Orthogonal projection of a consistent vector. Collective.
  virtual void project(std::span<double> x) const = 0;
};

/// Directions held at one local node, besides its held components.
struct HeldDirections {
  std::int32_t node = 0;
  int count = 0;
  std::array<Vector3, 3> basis{};  ///< orthonormal, in free components only
};

struct ConstrainedSpace {
  std::vector<HeldDirections> directions;
  std::shared_ptr<const HeldRows> rows;  ///< may be null; they share no node with the directions

  /// Orthogonal projection of a vector with `dim` components per node, node by node; collective if there are
  /// rows.
  void project(std::size_t dim, std::span<double> x) const;
  void project(std::size_t dim, std::span<float> x) const;
};

/// Inputs of a setup besides g: blocks of owned nodes, and the space of the solves.
struct NodeSupports {
  std::span<const NodeBlock> blocks;
  const ConstrainedSpace& space;
};

/// A body, or a rank's part of one. Elements are distributed over the ranks without overlap; vectors are
/// consistent: every copy of a shared entry has the same bits. All arrays must outlive their users.
struct MultigridBody {
  Body body;
  const IndexMap* node_map = nullptr;  ///< index map of the nodes
  std::span<const std::uint8_t> held;  ///< nodes × dim: nonzero for components held at zero
  /// An operator of this mesh and law_of_element, or null: its partitioning is reused, immediately or, in 3D,
  /// in a later setup.
  const Operator* like = nullptr;

  std::size_t dim() const noexcept { return dimension(body.mesh.type); }
  std::size_t nodes() const noexcept { return body.mesh.node_count(); }
  std::size_t unknowns() const noexcept { return body.mesh.coordinates.size(); }
  std::size_t owned_nodes() const noexcept { return node_map->owned; }
  std::size_t owned_unknowns() const noexcept { return owned_nodes() * dim(); }
};

/// Limits the bulk modulus to 1e5 times the shear modulus: of an entry's seven digits in single precision,
/// shear keeps two (theory: softened-bulk).
inline std::vector<Law> softened(std::span<const Law> laws) {
  constexpr double stiffest_bulk = 1e5;
  std::vector<Law> soft(laws.begin(), laws.end());
  for (Law& law : soft) law.bulk = std::min(law.bulk, stiffest_bulk * law.secant(0.0));
  return soft;
}

inline MultigridBody with_laws(MultigridBody body, std::span<const Law> laws) {
  body.body.laws = laws;
  return body;
}

}  // namespace kacanov
