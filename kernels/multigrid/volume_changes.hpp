// SPDX-License-Identifier: BSD-3-Clause
// Averaged volume changes as functions of nodal displacements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "multigrid/pressure_rows.hpp"

namespace kacanov {

/// B for some of this rank's nodes. Held components contribute nothing.
struct VolumeChanges {
  std::vector<std::int64_t> first;   ///< size owned nodes + 1, index into row
  std::vector<std::int32_t> row;     ///< rows that a node's displacement changes, as indices into `number`
  std::vector<float> change;         ///< the change per displacement: 3 values per row
  std::vector<std::int64_t> number;  ///< global numbers of rows of PressureRows
};

/// B of the `wanted` nodes: one flag per node of the body, the same on all ranks that have the node.
/// Collective.
VolumeChanges volume_changes(const MultigridBody& body, const PressureRows& pressures,
                             std::span<const char> wanted, int threads);
/// Only the pattern: `change` stays empty.
VolumeChanges changed_pressures(const MultigridBody& body, const PressureRows& pressures,
                                std::span<const char> wanted, int threads);

}  // namespace kacanov
