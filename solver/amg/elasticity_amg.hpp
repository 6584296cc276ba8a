// SPDX-License-Identifier: BSD-3-Clause
// Unknown-based BoomerAMG on the assembled penalised secant stiffness: robust, heavy; the yardstick.
#pragma once

#include "amg/assembly.hpp"
#include "amg/boomer_amg.hpp"
#include "linear/preconditioner.hpp"

namespace kacanov {

/// One V-cycle of BoomerAMG, the components of a node apart from each other (theory: elasticity-amg), on
/// B(g) + blocks with held components cut out. Directions that the space holds are left to the blocks.
class ElasticityAmg final : public Preconditioner {
 public:
  /// The part has to outlive it. Throws InputError where hypre cannot number the unknowns. Collective.
  explicit ElasticityAmg(const Part& part);
  void apply(std::span<const double> r, std::span<double> z) override;
  void secant(std::span<double> g) const override;

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override;
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override {
    build(std::vector<double>(g_), blocks, space);
  }

  const Part& part_;
  std::vector<double> g_;
  BoomerAmg amg_;
};

}  // namespace kacanov
