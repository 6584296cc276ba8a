// SPDX-License-Identifier: BSD-3-Clause
// The way to the full load: a part of a problem under a share of it.
#pragma once

#include <kacanov/part.hpp>

namespace kacanov {

/// Scales the loads and prescribed displacements of a part. Obstacles that press into the body at rest are
/// drawn back along their direction, each contact entry by the share still missing of its largest
/// indentation; open gaps of other entries and the friction bounds stay what they are.
class LoadPath {
 public:
  /// Collective. `part`, under its full load, has to outlive it and has that load again in the end.
  explicit LoadPath(Part& part);
  LoadPath(const LoadPath&) = delete;
  LoadPath& operator=(const LoadPath&) = delete;
  ~LoadPath();

  /// The part under `factor` of the load; with 1 it is the full one to the bit.
  void set(double factor);

 private:
  Part& part_;
  // Of the full load.
  std::vector<Part::ComponentValue> load_, prescribed_;
  std::vector<double> gap_,
      closed_;  ///< a contact point; how much of it the prescribed components of its node close
  std::vector<double> depth_;  ///< largest indentation, one a contact entry
};

}  // namespace kacanov
