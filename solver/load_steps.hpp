// SPDX-License-Identifier: BSD-3-Clause
// The way to the full load: the same part of a problem under a share of it.
#pragma once

#include "part.hpp"

namespace kacanov {

/// A part whose loads and prescribed displacements can be scaled. Obstacles that press into the body at rest are drawn
/// back along their direction, each contact entry by the share still missing of its largest indentation; open gaps
/// of other entries and the friction bounds stay what they are.
class LoadPath {
 public:
  /// Collective. Keeps a copy of `full`, which has to outlive it.
  explicit LoadPath(const Part& full);

  /// The part under `factor` of the load; with 1 it is `full` to the bit.
  void set(double factor);
  const Part& part() const noexcept { return part_; }

 private:
  const Part* full_;
  Part part_;
  std::vector<double> depth_;  ///< largest indentation, one a contact entry
};

}  // namespace kacanov
