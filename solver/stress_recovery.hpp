// SPDX-License-Identifier: BSD-3-Clause
// Stress at nodes, from the polynomials round the corners.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/nodal_stress.hpp>
#include "patches.hpp"

namespace kacanov {

/// Takes one batch of materials after the other.
class StressRecovery {
 public:
  StressRecovery(const Part& part, const Patches& patches);
  /// What the fits have of stress, in that set. Collective.
  void take(const PatchFits& fits, std::size_t set, std::int32_t batch);
  /// To be called last. Collective.
  NodalStress result();

 private:
  void take(std::size_t node, const Patches::Values& stress);
  /// Ranks that have a middle but no element of this material there hear of it from the others.
  void take_middles(const PatchFits& fits, std::size_t set, std::int32_t batch);

  const Part& part_;
  const Patches& patches_;
  std::vector<double> seen_;
  NodalStress out_;
};

}  // namespace kacanov
