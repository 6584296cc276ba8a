// SPDX-License-Identifier: BSD-3-Clause
// Adapter of the kernels' multigrid to the Preconditioner interface for a part.
#pragma once

#include <kacanov/part.hpp>
#include "linear/preconditioner.hpp"
#include "multigrid/multigrid.hpp"

namespace kacanov {

/// Returns the part in the form that the multigrid needs; the part must outlive it.
inline MultigridBody multigrid_body(const Part& part, const Operator* like = nullptr) {
  return {part.body(), &part.node_map, part.held, like};
}

class PartMultigrid final : public Preconditioner {
 public:
  /// Does not set up yet. The part must outlive it. A setup throws InternalError if the coarsest matrix is
  /// not positive definite.
  PartMultigrid(const Part& part, const MultigridOptions& options, const Operator* like = nullptr)
      : multigrid_(multigrid_body(part, like), options) {}
  void apply(std::span<const double> r, std::span<double> z) override { multigrid_.apply(r, z); }
  void secant(std::span<double> g) const override { multigrid_.secant(g); }
  int kind() const noexcept override { return multigrid_.kind(); }

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override {
    multigrid_.build(g, blocks, space.held());
  }
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override {
    multigrid_.rebuild(blocks, space.held());
  }

  Multigrid multigrid_;
};

}  // namespace kacanov
