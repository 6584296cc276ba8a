// SPDX-License-Identifier: BSD-3-Clause
// The space a solve lives in: which components are free, and its inner product over all ranks.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "part.hpp"

namespace kacanov {

using Vector = std::vector<double>;

/// Displacements of a part that vanish in held components and, optionally, in some directions of some nodes
/// (contact rows held during a spectrum or active-set solve).
class Space {
 public:
  explicit Space(const Part& part) : part_(&part) {}

  /// Holds `direction` at a local node as well; directions of one node may be dependent. Call on every rank
  /// that has a copy of the node.
  void hold(std::int32_t node, const Vector3& direction);

  /// Directions held at one local node besides its held components.
  struct HeldDirections {
    std::int32_t node = 0;
    int count = 0;
    std::array<Vector3, 3> basis{};  ///< orthonormal, in free components only
  };
  std::span<const HeldDirections> held_directions() const noexcept { return held_; }

  std::size_t size() const noexcept { return part_->unknowns(); }
  const Part& part() const noexcept { return *part_; }

  /// Orthogonal projection onto the space, node by node.
  void project(std::span<double> x) const;
  void project(std::span<float> x) const;
  double dot(std::span<const double> x, std::span<const double> y) const;
  double norm(std::span<const double> x) const;
  /// a·b and c·d for the price of one reduction.
  std::array<double, 2> dot2(std::span<const double> a, std::span<const double> b, std::span<const double> c,
                             std::span<const double> d) const;
  double max_abs(std::span<const double> x) const;

 private:
  double local_dot(std::span<const double> x, std::span<const double> y) const;

  const Part* part_;
  std::vector<HeldDirections> held_;
};

}  // namespace kacanov
