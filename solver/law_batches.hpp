// SPDX-License-Identifier: BSD-3-Clause
// Materials that can be gone through together, because no node belongs to two of them.
#pragma once

#include <cstdint>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// The batch of every law of the part, from 0 on: no two laws of a batch share a node, on any rank. Greedy in
/// the order of the laws, the same on every rank. Collective.
std::vector<std::int32_t> law_batches(const Part& part);

}  // namespace kacanov
