// SPDX-License-Identifier: BSD-3-Clause
// The space a solve lives in: which components are free, and its inner product over all ranks.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

using Vector = std::vector<double>;

/// Σ term(i) over i < n, as eight sums: the compiler may not reorder one.
template <class Term>
double eight_sums(std::size_t n, const Term& term) {
  std::array<double, 8> s{};
  const std::size_t whole = n - n % 8;
  for (std::size_t i = 0; i < whole; i += 8)
    for (std::size_t k = 0; k < 8; ++k) s[k] += term(i + k);
  for (std::size_t i = whole; i < n; ++i) s[0] += term(i);
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

/// Rows over several nodes that a space holds at zero.
class HeldRows {
 public:
  virtual ~HeldRows() = default;
  /// Orthogonal projection of a consistent vector (unknowns of the part). Collective.
  virtual void project(std::span<double> x) const = 0;
};

/// Displacements of a part that vanish in held components and, optionally, in some directions of some nodes
/// and in rows over several nodes (contact rows held during a spectrum or active-set solve).
class Space {
 public:
  /// Held are the prescribed components alone. The part has to outlive it.
  explicit Space(const Part& part) : part_(&part) {}

  /// Holds `direction` at a local node as well; directions of one node may be dependent. Call on every rank
  /// that has a copy of the node.
  void hold(std::int32_t node, const Vector3& direction);
  /// Holds rows that share no node with these directions. Call on every rank.
  void hold(std::shared_ptr<const HeldRows> rows) { rows_ = std::move(rows); }

  /// Directions held at one local node besides its held components.
  struct HeldDirections {
    std::int32_t node = 0;
    int count = 0;
    std::array<Vector3, 3> basis{};  ///< orthonormal, in free components only
  };
  std::span<const HeldDirections> held_directions() const noexcept { return held_; }

  std::size_t size() const noexcept { return part_->unknowns(); }
  const Part& part() const noexcept { return *part_; }

  /// Orthogonal projection onto the space, node by node; collective where rows over several nodes are held.
  void project(std::span<double> x) const;
  void project(std::span<float> x) const;
  /// Inner product and 2-norm of consistent vectors over all ranks, each unknown once. Collective.
  double dot(std::span<const double> x, std::span<const double> y) const;
  double norm(std::span<const double> x) const;
  /// a·b and c·d for the price of one reduction. Collective.
  std::array<double, 2> dot2(std::span<const double> a, std::span<const double> b, std::span<const double> c,
                             std::span<const double> d) const;
  /// max |x_i| over all ranks. Collective.
  double max_abs(std::span<const double> x) const;
  /// Over all ranks, of what each has. Collective.
  double sum_all(double share) const { return part_->node_map.sum_all(share); }
  /// A step of conjugate gradients in one pass: x += α p, r −= α q. Returns ‖r‖. Collective.
  double advance(double alpha, std::span<const double> p, std::span<const double> q, std::span<double> x,
                 std::span<double> r) const;

 private:
  double local_dot(std::span<const double> x, std::span<const double> y) const;

  const Part* part_;
  std::vector<HeldDirections> held_;
  std::shared_ptr<const HeldRows> rows_;
};

}  // namespace kacanov
