// SPDX-License-Identifier: BSD-3-Clause
// Partitioning of a body: units, grouped into blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <kacanov/reference.hpp>
#include "operator/units.hpp"

namespace kacanov {

struct Layout;

/// The part of the layout that does not depend on the number of lanes, and little on the precision.
struct Division {
  Units units;
  std::vector<std::vector<std::uint32_t>> blocks;  ///< units of each block, in locality order
  std::vector<std::int32_t> rank;                  ///< per node: locality number, close for close nodes
};

/// Makes blocks that fit in a core's second-level cache with `record_bytes` per node record, at least one per
/// thread if the body is large enough.
Division divide(const Body& body, int threads, std::size_t record_bytes);

/// Reuses the partitioning of an operator with the same mesh and law_of_element, merging `joined` of its
/// blocks into one. Skips the fan cover, METIS and the Hilbert curve, which take four fifths of the time.
Division divided_as(const Layout& like, const Body& body, std::size_t joined);

}  // namespace kacanov
