// SPDX-License-Identifier: BSD-3-Clause
// How a body is divided: units, and which of them make a block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <kacanov/reference.hpp>
#include "operator/units.hpp"

namespace kacanov {

struct Layout;

/// What does not depend on lanes, and little on the size of a number.
struct Division {
  Units units;
  std::vector<std::vector<std::uint32_t>> blocks;  ///< units of each, in the order of their places
  std::vector<std::int32_t> rank;                  ///< of a node: near ones have near numbers
};

/// Blocks that work in a core's second-level cache where a record of a node has `record_bytes`, at least one
/// a thread where the body allows it.
Division divide(const Body& body, int threads, std::size_t record_bytes);

/// That of an operator of the same mesh and the same laws of elements, with `joined` of its blocks a block:
/// no cover, no METIS, no curve, which take four fifths of the time.
Division divided_as(const Layout& like, const Body& body, std::size_t joined);

}  // namespace kacanov
