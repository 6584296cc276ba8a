// SPDX-License-Identifier: BSD-3-Clause
// A sparse factor of the assembled secant stiffness: for small bodies that multigrid cannot precondition.
#pragma once

#include <memory>

#include "amg/assembly.hpp"
#include "linear/preconditioner.hpp"

namespace kacanov {

/// (B(g) + blocks)⁻¹ in double precision (theory: factorised), the same factor on every rank. Directions that
/// the space holds are left to the blocks.
class Factorised final : public Preconditioner {
 public:
  /// Nothing is set up yet. The part has to outlive it. A setup throws InternalError where the matrix is not
  /// definite. Not collective.
  explicit Factorised(const Part& part);
  ~Factorised() override;
  void apply(std::span<const double> r, std::span<double> z) override;
  void secant(std::span<double> g) const override;

 private:
  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override;
  void rebuild(std::span<const NodeBlock> blocks, const Space& space) override {
    build(std::vector<double>(g_), blocks, space);
  }

  struct Factor;
  const Part* part_;
  NodeGraph graph_;
  std::vector<double> g_;
  std::unique_ptr<Factor> factor_;
};

}  // namespace kacanov
