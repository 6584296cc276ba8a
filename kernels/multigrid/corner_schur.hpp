// SPDX-License-Identifier: BSD-3-Clause
// The Schur complement of the pressures at corners, as a matrix.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "multigrid/corner_pressures.hpp"
#include "multigrid/pressure_steps.hpp"
#include "multigrid/summed_pattern.hpp"

namespace kacanov {

/// S = B Â⁻¹ Bᵀ + C over the rows of CornerPressures, Â of node blocks (theory: pressure-smoothing). B and
/// which rows couple depend on the mesh alone, they are found once.
class CornerSchur {
 public:
  /// Collective.
  CornerSchur(const MultigridBody& body, const CornerPressures& pressures, int threads);

  /// For Â⁻¹ = factor times blocks of local nodes, packed as FineLevel::inverse; held components give
  /// nothing. Collective.
  void build(std::span<const float> inverse, double factor, std::span<const double> compliance);
  /// p += S⁻¹ (q − S p), nearly; `from_zero`: p is zero. p has room for size() entries, q this rank's rows.
  /// Collective.
  void improve(bool from_zero, const PressureSteps& steps, std::span<const double> q, std::span<double> p);
  /// y = S p. Collective.
  void multiply(std::span<double> p, std::span<double> y);

  std::size_t size() const noexcept { return pattern_->columns().size(); }
  std::size_t bytes() const noexcept;

 private:
  void take_changes(const MultigridBody& body, const CornerPressures& pressures);
  void sum_rows(std::span<const float> inverse, double factor, std::size_t begin, std::size_t end);
  template <class Real>
  void times(Scatterer<Real>& fill, std::span<Real> p, std::span<Real> y);

  int threads_;
  std::size_t nodes_;  ///< that this rank owns
  // B by nodes, without held components.
  std::vector<std::int64_t> first_;  ///< nodes + 1, into
  std::vector<std::int32_t> row_;    ///< that a node's displacement changes, as a column of S
  std::vector<float> change_;        ///< by so much: 3 for each of those
  std::vector<std::int64_t> first_node_;
  std::vector<std::int32_t> node_;  ///< that have something to do with a row
  std::optional<SummedPattern> pattern_;
  std::vector<float> value_, inverse_;  ///< of S, of its diagonal
  std::vector<double> image_;           ///< scratch
  std::optional<Scatterer<double>> fill_;
  std::optional<Scatterer<float>> fill_single_;
  PressureSolve solve_;
};

}  // namespace kacanov
