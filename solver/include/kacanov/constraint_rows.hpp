// SPDX-License-Identifier: BSD-3-Clause
// Contact as constraint rows, sparse in the nodes: the common form of all kinds of contact.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/model.hpp>

namespace kacanov {

/// Coefficients of one node's displacement u in the rows of a contact point.
struct RowEntry {
  std::int32_t node = 0;
  Vector3 normal{};  ///< coefficients of u in N·u, prescribed components included
  Vector3 trace{};   ///< the same in free components only: the node's share of the contact force
  std::array<Vector3, 2> tangent{};  ///< coefficients in T·u, in free components
};

/// A group of rows with one gap, one pressure and one friction bound: N·u ≤ gap and, with friction, the
/// tangential trace T·u. Its entries are stored in ConstraintRows (theory: traces).
struct ContactPoint {
  std::int32_t node = 0;             ///< represents the point in output and messages; its owner owns the rows
  std::int32_t entry = 0;            ///< index into Model::contact
  std::int32_t loose_piece = -1;     ///< index into Problem::loose_pieces of the node's piece, −1: none
  Vector3 normal{};                  ///< ν, unit, from the body towards the obstacle
  Vector3 outer{};                   ///< the body's outer normal, of any length; for obstacles that move
  std::array<Vector3, 2> tangent{};  ///< orthonormal directions of the tangential traction
  int tangents = 0;                  ///< rows of T; 0 without friction
  double gap = 0.0;                  ///< ρ
  double unknown_gap = 0.0;          ///< bound on the rounding error of the gap (theory: gap-rounding)
  double mass = 0.0;                 ///< lumped contact mass M, an area (a length in 2D)
  double tresca = 0.0;               ///< ψ without pressure
  double coulomb = 0.0;              ///< μ_f
  bool since_step = false;           ///< slip is measured from the end of the previous load step

  /// The friction bound ψ under this pressure ≥ 0 (theory: coulomb).
  double friction_bound(double pressure) const noexcept { return tresca + coulomb * pressure; }
};

/// Contact points and their entries in compressed rows. A point with one entry is *narrow* (a node against an
/// obstacle), one with several is *wide*: a multi-node contact point (a facet against an obstacle or another
/// body).
class ConstraintRows {
 public:
  std::size_t size() const noexcept { return points_.size(); }
  bool empty() const noexcept { return points_.empty(); }
  ContactPoint& operator[](std::size_t i) noexcept { return points_[i]; }
  const ContactPoint& operator[](std::size_t i) const noexcept { return points_[i]; }
  auto begin() noexcept { return points_.begin(); }
  auto end() noexcept { return points_.end(); }
  auto begin() const noexcept { return points_.begin(); }
  auto end() const noexcept { return points_.end(); }
  std::span<const ContactPoint> points() const noexcept { return points_; }

  /// Entries of point i; their nodes are distinct.
  std::span<const RowEntry> entries(std::size_t i) const noexcept {
    return std::span(entries_).subspan(start_[i], start_[i + 1] - start_[i]);
  }
  bool is_wide(std::size_t i) const noexcept { return start_[i + 1] - start_[i] > 1; }
  bool any_wide() const noexcept { return entries_.size() > points_.size(); }

  /// Appends `point`. Points of the same node must be consecutive; `entries` must not be empty.
  void push_back(const ContactPoint& point, std::span<const RowEntry> entries) {
    points_.push_back(point);
    entries_.insert(entries_.end(), entries.begin(), entries.end());
    start_.push_back(static_cast<std::uint32_t>(entries_.size()));
  }
  /// Calls f(node), which changes the number in place, for every node index stored in points and entries.
  template <class F>
  void renumber(const F& f) {
    for (ContactPoint& point : points_) f(point.node);
    for (RowEntry& entry : entries_) f(entry.node);
  }

  /// Whether every point has its entries, as push_back() ensures; data read from a file may violate this.
  bool consistent() const noexcept {
    if (start_.size() != points_.size() + 1 || start_.front() != 0 || start_.back() != entries_.size())
      return false;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (start_[i + 1] <= start_[i]) return false;
    return true;
  }
  /// Passes its fields to `stream`, to write or read files and messages.
  template <class Rows, class Stream>
  static void exchange(Rows& rows, const Stream& stream) {
    stream(rows.points_, rows.start_, rows.entries_);
  }

 private:
  std::vector<ContactPoint> points_;
  std::vector<std::uint32_t> start_ = {0};  ///< points + 1
  std::vector<RowEntry> entries_;
};

}  // namespace kacanov
