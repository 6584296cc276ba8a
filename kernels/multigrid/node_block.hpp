// SPDX-License-Identifier: BSD-3-Clause
// Stiffness blocks added to an operator at nodes.
#pragma once

#include <array>
#include <cstdint>

namespace kacanov {

/// A dim × dim block added to the diagonal block of a node: a contact penalty, a slip stiffness, or a held
/// direction.
struct NodeBlock {
  std::int32_t node = 0;
  std::array<double, 9> value{};  ///< dim × dim, row-major
};

}  // namespace kacanov
