// SPDX-License-Identifier: BSD-3-Clause
// The assembled Schur complement of the pressures.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "multigrid/pressure_rows.hpp"
#include "multigrid/pressure_steps.hpp"
#include "multigrid/summed_pattern.hpp"
#include "multigrid/volume_changes.hpp"

namespace kacanov {

/// S = B Â⁻¹ Bᵀ + C over the rows of PressureRows, with Â of node blocks (theory: pressure-smoothing). B
/// depends only on the mesh, but needs four times S's memory: it is recomputed in parts whenever it is
/// needed.
class PressureSchur {
 public:
  /// Finds the sparsity pattern. B is computed for this many nodes at a time, or for an eighth of a rank's if
  /// that is more: every part loops over all elements. The arguments must outlive it. Collective.
  PressureSchur(const MultigridBody& body, const PressureRows& pressures, int threads,
                std::int64_t nodes_at_once = 1 << 15);

  /// For Â⁻¹ = factor times blocks of local nodes, packed as in FineLevel::inverse; held components
  /// contribute nothing. Collective.
  void build(std::span<const float> inverse, double factor);
  /// Updates S from the blocks `before` of the last build to `inverse`, with the same factor. Collective.
  void change(std::span<const float> before, std::span<const float> inverse);
  /// p += S⁻¹ rest, approximately; for this rank's rows. Collective.
  void improve(const PressureSteps& steps, std::span<const double> rest, std::span<double> p);
  /// y = S p; p has room for size() entries. Collective.
  void multiply(std::span<double> p, std::span<double> y);

  std::size_t size() const noexcept { return pattern_->columns().size(); }
  std::size_t bytes() const noexcept;

 private:
  void add(const VolumeChanges& b, std::span<const float> inverse, std::span<const float> before);
  void take_diagonal();
  template <class Real>
  void times(Scatterer<Real>& fill, std::span<Real> p, std::span<Real> y);

  const MultigridBody* body_;
  const PressureRows* pressures_;
  int threads_;
  std::int64_t nodes_at_once_;
  double factor_ = 1.0;
  std::optional<SummedPattern> pattern_;
  std::vector<float> value_, inverse_;  ///< of S, of its diagonal
  std::optional<Scatterer<double>> fill_;
  std::optional<Scatterer<float>> fill_single_;
  PressureSolve solve_;
};

}  // namespace kacanov
