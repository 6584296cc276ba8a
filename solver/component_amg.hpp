// SPDX-License-Identifier: BSD-3-Clause
// A scalar BoomerAMG for each displacement component, with a coarse space of rigid motions.
#pragma once

#include <memory>
#include <vector>

#include "assembly.hpp"
#include "boomer_amg.hpp"
#include "preconditioner.hpp"
#include "rigid_coarse.hpp"

namespace kacanov {

/// z = Σ_c AMG_c r_c + Z (Zᵀ A Z)⁻¹ Zᵀ r. AMG_c sees the diagonal block A_cc of the secant stiffness, a Laplacian
/// weighted by g; by Korn's inequality the A_cc together are equivalent to A, with a constant that is bad for
/// bending, which Z, the rigid motions of aggregates, takes over.
class ComponentAmg final : public Preconditioner {
 public:
  explicit ComponentAmg(const Part& part);
  void apply(std::span<const double> r, std::span<double> z) override;

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override;

  const Part& part_;
  std::vector<std::unique_ptr<BoomerAmg>> component_;
  RigidCoarse coarse_;
  Vector right_, left_;
};

}  // namespace kacanov
