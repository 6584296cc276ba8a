// SPDX-License-Identifier: BSD-3-Clause
// How displacements of nodes change averaged volumes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "multigrid/pressure_rows.hpp"

namespace kacanov {

/// B of some of this rank's nodes. Held components change nothing.
struct VolumeChanges {
  std::vector<std::int64_t> first;   ///< owned nodes + 1, into
  std::vector<std::int32_t> row;     ///< that a node's displacement changes, as an index of `number`
  std::vector<float> change;         ///< by so much: 3 for each of those
  std::vector<std::int64_t> number;  ///< over all ranks, of rows of PressureRows
};

/// Of the nodes that are `wanted`: for each of the body's nodes, the same on all ranks that have it.
/// Collective.
VolumeChanges volume_changes(const MultigridBody& body, const PressureRows& pressures,
                             std::span<const char> wanted, int threads);
/// The same without `change`, which stays empty.
VolumeChanges changed_pressures(const MultigridBody& body, const PressureRows& pressures,
                                std::span<const char> wanted, int threads);

}  // namespace kacanov
