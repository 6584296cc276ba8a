// SPDX-License-Identifier: BSD-3-Clause
// One level of displacements and pressures on a background grid: its matrix and its smoother.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/scatterer.hpp>
#include "multigrid/pressure_steps.hpp"
#include "multigrid/rigid_level.hpp"
#include "simd/grid_rows.hpp"

namespace kacanov {

/// Displacements (four values a row, the last one 0) and pressures (one), or what acts on them. Both have
/// room for ghosts.
struct GridVector {
  static constexpr std::size_t width = 4;
  std::vector<double> u, p;
  void resize(std::size_t rows) { u.resize(width * rows), p.resize(rows); }
  void clear() { u.assign(u.size(), 0.0), p.assign(p.size(), 0.0); }
};

/// K = [A Bᵀ; B −C] over the rows of a grid, distributed by rows, and the inexact smoother of Braess and
/// Sarazin on it (theory: pressure-smoothing).
class GridLevel {
 public:
  /// `starts`: the first row of each rank, and their number. `sums` are this rank's contributions to any
  /// rows. Collective.
  GridLevel(std::span<const std::int64_t> starts, BlockSums<4> sums, const Communicator& comm, int threads);

  std::size_t rows() const noexcept { return rows_; }
  const IndexMap& map() const noexcept { return *map_; }
  /// The whole matrix, as long as it has not been let go.
  const RigidLevel<4>& blocks() const noexcept { return *blocks_; }
  void forget_blocks() { blocks_.reset(); }

  /// `steps` steps on x for the input b, from zero if that is said. Collective.
  void smooth(bool from_zero, int steps, const PressureSteps& with, const GridVector& b, GridVector& x);
  /// r = b − K x on owned rows. Collective.
  void residual(const GridVector& b, GridVector& x, GridVector& r);
  std::size_t bytes() const noexcept;

 private:
  void take_rows();
  void find_scales();
  void fill(std::vector<double>& x, Scatterer<double>& scatterer);
  simd::GridRow row(std::size_t i) const {
    return {column_.data(), static_cast<std::size_t>(start_[i]), static_cast<std::size_t>(start_[i + 1])};
  }
  /// y = A u, y = Bᵀ p, q = B u, q = C p on owned rows; ghosts of what they are of have been filled.
  void force(std::span<const double> u, std::span<double> y) const;
  void gradient(std::span<const double> p, std::span<double> y) const;
  void divergence(std::span<const double> u, std::span<double> q) const;
  void compliance(std::span<const double> p, std::span<double> q) const;
  /// y = Â⁻¹ x, or y += sign times that.
  void scale(std::span<const double> x, std::span<double> y) const;
  void add_scaled(double sign, std::span<const double> x, std::span<double> y) const;
  /// q = S p.
  void schur(std::span<double> p, std::span<double> q);

  std::size_t rows_;
  int threads_;
  std::optional<RigidLevel<4>> blocks_;
  std::unique_ptr<const IndexMap> map_;
  std::vector<std::int64_t> start_;
  std::vector<std::int32_t> column_;
  std::vector<float> a_, gradient_, divergence_, compliance_;  ///< 12, 4, 4, 1 an entry: see grid_rows.hpp
  std::vector<double> inverse_;                                ///< of Â: rows × three columns of four
  std::vector<double> schur_inverse_;                          ///< of S's diagonal
  PressureSolve solve_;
  std::optional<Scatterer<double>> fill_u_, fill_p_;
  std::vector<double> image_, change_, lifted_;  ///< scratch
};

}  // namespace kacanov
