// SPDX-License-Identifier: BSD-3-Clause
// The Schur complement of the pressures at corners, as a matrix.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "multigrid/corner_pressures.hpp"
#include "multigrid/pressure_steps.hpp"
#include "multigrid/rigid_level.hpp"

namespace kacanov {

/// S = B Â⁻¹ Bᵀ + C over the rows of CornerPressures, Â of node blocks (theory: pressure-smoothing).
/// Couplings depend on the mesh alone, they are found once.
class CornerSchur {
 public:
  /// Collective.
  CornerSchur(const MultigridBody& body, const CornerPressures& pressures, int threads);

  /// For Â⁻¹ = factor times blocks of local nodes, packed as FineLevel::inverse; held components give
  /// nothing. Collective.
  void build(std::span<const float> inverse, double factor, std::span<const double> compliance);
  /// p += S⁻¹ (q − S p), nearly. p has room for size() entries, q this rank's rows. Collective.
  void improve(const PressureSteps& steps, std::span<const double> q, std::span<double> p);
  /// y = S p. Collective.
  void multiply(std::span<double> p, std::span<double> y);

  std::size_t size() const noexcept { return level_->size(); }
  std::size_t bytes() const noexcept;

 private:
  struct Entry {
    std::int32_t row;  ///< over all ranks
    std::array<float, 3> change;
  };
  std::size_t nodes_;
  std::vector<std::uint8_t> held_;
  std::vector<std::size_t> first_;  ///< owned nodes + 1, into
  std::vector<Entry> entries_;      ///< B by columns: what a node's displacement does to rows
  std::optional<RigidLevel<1>> level_;
  void take_rows();

  int threads_;
  std::vector<std::int64_t> start_;  ///< whole rows, in single precision
  std::vector<std::int32_t> column_;
  std::vector<float> value_;
  std::optional<Scatterer<double>> fill_;
  std::vector<double> inverse_;  ///< of the diagonal
  PressureSolve solve_;
};

}  // namespace kacanov
