// SPDX-License-Identifier: BSD-3-Clause
// Normal and tangential traces N, T at the contact points, with the lumped mass M.
#pragma once

#include <span>

#include "contact/multi_node_contact.hpp"
#include "linear/space.hpp"

namespace kacanov {

/// Penalties of the augmented Lagrangian: one for N, one for T.
struct Penalty {
  double normal = 0.0, tangential = 0.0;
};

/// Values at the contact points of a part, ghosts included; every copy has the same bits.
struct ContactValues {
  Vector normal;      ///< points
  Vector tangential;  ///< points × 2; unused entries stay 0
  explicit ContactValues(std::size_t points = 0) : normal(points, 0.0), tangential(2 * points, 0.0) {}
};

/// C = [N; T] of all contact points, and its transpose (theory: traces). Every rank with the node computes
/// forces of single-node points; owners compute those of multi-node points and send them.
class Traces {
 public:
  /// Collective. The part must outlive it.
  explicit Traces(const Part& part) : part_(&part), wide_(part) {}

  std::span<const ContactPoint> points() const noexcept { return part_->contact.points(); }
  std::span<const RowEntry> entries(std::size_t point) const noexcept {
    return part_->contact.entries(point);
  }
  std::size_t size() const noexcept { return part_->contact.size(); }
  std::size_t owned() const noexcept { return static_cast<std::size_t>(part_->owned_contact); }
  const Communicator& ranks() const noexcept { return part_->node_map; }
  const Part& part() const noexcept { return *part_; }

  /// values = (Nu, Tu) of the free components; the gap already accounts for prescribed ones.
  void evaluate(std::span<const double> u, ContactValues& values) const;
  /// y += factor · (Nᵀ M λ_n + Tᵀ M λ_t), in free components. Collective.
  void add_force(const ContactValues& lambda, double factor, std::span<double> y) const;
  /// y += (r_n NᵀMN + r_t TᵀMT) x for x in the space of free components. Returns this rank's share of the
  /// increase of xᵀ y. Collective.
  double add_penalty(const Penalty& r, std::span<const double> x, std::span<double> y) const;
  /// Returns ‖Nᵀ M λ_n + Tᵀ M λ_t‖ over all ranks (points of the same node are summed first). Collective.
  double force_norm(const ContactValues& lambda) const;

 private:
  const Part* part_;
  WideNodes wide_;
};

}  // namespace kacanov
