// SPDX-License-Identifier: BSD-3-Clause
// Constraints of a displacement space besides held components: directions at nodes, and rows over several
// nodes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/vector3.hpp>

namespace kacanov {

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

struct HeldSpace {
  std::vector<HeldDirections> directions;
  std::shared_ptr<const HeldRows> rows;  ///< may be null; they share no node with the directions

  /// Orthogonal projection of a vector with `dim` components per node, node by node; collective if there are
  /// rows.
  void project(std::size_t dim, std::span<double> x) const;
  void project(std::size_t dim, std::span<float> x) const;
};

}  // namespace kacanov
