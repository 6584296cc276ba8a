// SPDX-License-Identifier: BSD-3-Clause
// Element matrices in closed form, for those who assemble: multigrid setups.
#pragma once

#include <cstddef>
#include <span>

#include <kacanov/reference.hpp>

namespace kacanov {

/// The same matrix as reference::element_matrix, block by block instead of column by column:
/// K_ab = Σ volume [(k0 − 2g/3) ∇φ_a ⊗ ∇φ_b + g ∇φ_b ⊗ ∇φ_a + g (∇φ_a·∇φ_b) I], k0 with the element's mean
/// gradients where the law says so. `g` has the element's points;
/// (nodes·dim)² entries, row-major, node-major rows.
void element_stiffness(const Body& body, std::size_t element, std::span<const double> g,
                       std::span<double> matrix);

}  // namespace kacanov
