// SPDX-License-Identifier: BSD-3-Clause
// The divergence operator and the assembled Schur complement of the pressures.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "multigrid/cycle.hpp"
#include "multigrid/pressure_rows.hpp"
#include "multigrid/sparsity_pattern.hpp"

namespace kacanov {

/// B for some of this rank's nodes. Held components contribute nothing.
struct DivergenceOperator {
  std::vector<std::int64_t> first;   ///< size owned nodes + 1, index into row
  std::vector<std::int32_t> row;     ///< rows that a node's displacement changes, as indices into `number`
  std::vector<float> change;         ///< the change per displacement: 3 values per row
  std::vector<std::int64_t> number;  ///< global numbers of rows of PressureRows
};

/// B of the `wanted` nodes: one flag per node of the body, the same on all ranks that have the node.
/// Collective.
DivergenceOperator divergence_operator(const MultigridBody& body, const PressureRows& pressures,
                                       std::span<const char> wanted, int threads);
/// Only the pattern: `change` stays empty.
DivergenceOperator divergence_pattern(const MultigridBody& body, const PressureRows& pressures,
                                      std::span<const char> wanted, int threads);

/// S = B Â⁻¹ Bᵀ + C over the rows of PressureRows, with Â of node blocks (theory: pressure-smoothing). B
/// depends only on the mesh, but needs four times S's memory: it is recomputed in parts whenever it is
/// needed.
class SchurComplement {
 public:
  /// Finds the sparsity pattern. B is computed for this many nodes at a time, or for an eighth of a rank's if
  /// that is more: every part loops over all elements. The arguments must outlive it. Collective.
  SchurComplement(const MultigridBody& body, const PressureRows& pressures, int threads,
                  std::int64_t nodes_at_once = 1 << 15);

  /// For Â⁻¹ = factor times blocks of local nodes, packed as in FineLevel::inverse; held components
  /// contribute nothing. Collective.
  void setup(std::span<const float> inverse, double factor);
  /// Updates S from the blocks `before` of the last setup to `inverse`, with the same factor. Collective.
  void update(std::span<const float> before, std::span<const float> inverse);
  /// p += S⁻¹ rest, approximately; for this rank's rows. Collective.
  void improve(const PressureSteps& steps, std::span<const double> rest, std::span<double> p);
  /// y = S p; p has room for size() entries. Collective.
  void multiply(std::span<double> p, std::span<double> y);

  std::size_t size() const noexcept { return pattern_->columns().size(); }
  std::size_t bytes() const noexcept;

 private:
  void add(const DivergenceOperator& b, std::span<const float> inverse, std::span<const float> before);
  void take_diagonal();
  template <class Real>
  void times(Scatterer<Real>& fill, std::span<Real> p, std::span<Real> y);

  const MultigridBody* body_;
  const PressureRows* pressures_;
  int threads_;
  std::int64_t nodes_at_once_;
  double factor_ = 1.0;
  std::optional<SparsityPattern> pattern_;
  std::vector<float> value_, inverse_;  ///< of S, of its diagonal
  std::optional<Scatterer<double>> fill_;
  std::optional<Scatterer<float>> fill_single_;
  PressureSolve solve_;
};

}  // namespace kacanov
