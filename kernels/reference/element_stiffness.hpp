// SPDX-License-Identifier: BSD-3-Clause
// Element stiffness matrices in closed form, for multigrid setups.
#pragma once

#include <cstddef>
#include <span>

#include <kacanov/reference.hpp>

namespace kacanov {

/// The matrix of reference::element_matrix, computed block by block instead of column by column: K_ab = Σ
/// volume [(k0 − 2g/3) ∇φ_a ⊗ ∇φ_b + g ∇φ_b ⊗ ∇φ_a + g (∇φ_a·∇φ_b) I], with the element's average gradients
/// for k0 if the law has mean_dilatation. `g`: one value per point of the element. `matrix`: (nodes·dim)²
/// entries, row-major, the components of a node contiguous.
void element_stiffness(const Body& body, std::size_t element, std::span<const double> g,
                       std::span<double> matrix);

}  // namespace kacanov
