// SPDX-License-Identifier: BSD-3-Clause
// The contact rows of a part whose obstacles move.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include "moving/obstacle_motion.hpp"

namespace kacanov {

/// Puts the rows, gaps and slip origins of a part where its obstacles are at a time (theory:
/// moving-obstacles). Everything is collective.
class MovingContact {
 public:
  /// `part` and `model` have to outlive it.
  MovingContact(Part& part, const Model& model);

  /// At the end `time` of a load step that began at `before` with the displacement u. Entries that are pushed
  /// stay where push() left them.
  void face(double time, double before, std::span<const double> u);
  /// Where an entry that is pushed has gone along its direction, counted from where the case has it.
  void push(std::size_t entry, double travel);
  /// Moves a pushed entry, whose force is 0 in this load step, out of the body's way. The next step counts
  /// its travel from where the case has it.
  void withdraw(std::size_t entry);
  /// The least travel with which a pushed entry, as it is faced, reaches a node at u = 0; 0 where none is in
  /// its way.
  double touch(std::size_t entry) const;

  static Vector3 direction(const ContactEntry& entry);

  /// For a checkpoint: how far each entry had been pushed when it was faced last, and its converse, for
  /// face() to be called as it was then.
  std::span<const double> faced_at() const noexcept { return faced_at_; }
  void resume(std::span<const double> faced_at) { travel_.assign(faced_at.begin(), faced_at.end()); }

 private:
  struct View;
  View view(const ContactEntry& entry, const SurfacePoint& at, const Vector3& u,
            const std::array<double, 2>& times, double travel) const;
  /// Counts the slip of a point whose obstacle stays from u, the end of the load step before.
  void count_from(std::size_t i, std::span<const double> u);
  /// Turns a point to the obstacle and gives its row; nothing, and a gap out of reach, where the obstacle is
  /// out of its way or the node can hardly move towards it: it keeps the row that it has in the case then.
  std::optional<RowEntry> take(std::size_t i, const View& view, std::span<const double> u,
                               ContactPoint& point);

  std::optional<RowEntry> row_along(const Vector3& normal, ContactPoint& point) const;

  Part& part_;
  const Model& model_;
  const ConstraintRows there_;  ///< as the case has them
  double far_;
  std::vector<double> travel_, faced_at_;  ///< one an entry of the model: now, and when it was faced
  std::vector<double> gap_;                ///< one a point: as it was faced
  std::vector<Vector3> origin_;            ///< displacement that slip is counted from, as it was faced
};

}  // namespace kacanov
