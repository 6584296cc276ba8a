// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form on the trilinear functions of a leaf, computed from its moments (theory:
// background-grid).
#pragma once

#include <array>
#include <cstddef>

#include "multigrid/leaf_moments.hpp"

namespace kacanov {

/// [A Bᵀ; B −C] of a leaf's eight corner functions: blocks of three displacements and the pressure, rows of
/// four. −C includes a stabilisation of pressures that alternate between corners, which trilinear
/// displacements do not see: besides p²/k0 they store (p − p̄)²/2g, p̄ and g averaged over the leaf (Dohrmann
/// and Bochev, Int. J. Numer. Meth. Fluids 46 (2004) 183–201).
class LeafForm {
 public:
  using Block = std::array<double, 16>;

  /// `stiffness` may be null.
  LeafForm(const LeafMoments& moments, const StiffnessMoments* stiffness, double length);
  /// Row i, column j.
  const Block& block(std::size_t i, std::size_t j) const { return block_[8 * i + j]; }

 private:
  void add_stiffness(const StiffnessMoments& stiffness);
  void add_stabilisation(const std::array<double, 64>& mass, double softness);
  void mirror();

  std::array<Block, 64> block_;
};

}  // namespace kacanov
