// SPDX-License-Identifier: BSD-3-Clause
// What is added to an operator node by node.
#pragma once

#include <array>
#include <cstdint>

namespace kacanov {

/// A dim × dim block added to the diagonal of a node: a contact penalty, a slip stiffness, or a direction
/// held.
struct NodeBlock {
  std::int32_t node = 0;
  std::array<double, 9> value{};  ///< dim × dim, row-major
};

}  // namespace kacanov
