// SPDX-License-Identifier: BSD-3-Clause
// Rows that share nodes: their joint pseudo-inverse, and the projection that holds them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contact/multi_node_contact.hpp"
#include "linear/space.hpp"

namespace kacanov {

/// One row over several nodes.
struct ClusterRow {
  struct Share {
    std::int32_t node = 0;
    Vector3 coefficient{};
  };
  std::size_t row = 0;      ///< index in the local rows of its TraceRows
  std::int64_t number = 0;  ///< global number
  std::vector<Share> shares;

  /// Returns the row's value for a displacement.
  double of(std::span<const double> u, std::size_t dim) const {
    double sum = 0.0;
    for (const Share& share : shares)
      for (std::size_t c = 0; c < dim; ++c)
        sum += share.coefficient[c] * u[static_cast<std::size_t>(share.node) * dim + c];
    return sum;
  }
};

/// C⁺ = Cᵀ (C Cᵀ)⁺ for rows C, with the sparse factor of C Cᵀ, which is no larger than a contact surface, on
/// every rank. Rows may be linearly dependent.
class RowCluster final : public HeldRows {
 public:
  /// Keeps the factor of dependent rows finite. Its relative error for independent rows (shift over the
  /// smallest eigenvalue of the scaled C Cᵀ) is squared by one refinement step.
  static constexpr double shift = 1e-12;

  /// `rows`: the rows this rank owns, at nodes of multi-node points only. Collective. The part must outlive
  /// it.
  RowCluster(const Part& part, const WideNodes& nodes, std::vector<ClusterRow> rows);
  ~RowCluster() override;

  std::span<const ClusterRow> rows() const noexcept { return rows_; }
  /// Returns (C Cᵀ)⁺ b, with the same bits on every rank; calls b(row) for the owned rows. Collective.
  template <class Value>
  Vector solve(const Value& b) const {
    Vector all(numbers_.size(), 0.0);
    for (const ClusterRow& row : rows_) all[position(row.number)] = b(row);
    solve_gathered(all);
    return all;
  }
  /// Returns the position of the row with this number in the result of solve().
  std::size_t position(std::int64_t number) const noexcept;
  /// y += Cᵀ z, with z from solve(); consistent. Collective.
  void add_transpose(std::span<const double> z, std::span<double> y) const;
  /// x −= C⁺ C x. Collective.
  void project(std::span<double> x) const override;

 private:
  void solve_gathered(Vector& b) const;

  const Part* part_;
  WideNodes nodes_;
  std::vector<ClusterRow> rows_;
  std::vector<std::int64_t> numbers_;  ///< rows of all ranks, ascending
  struct Factor;
  std::unique_ptr<const Factor> factor_;
};

}  // namespace kacanov
