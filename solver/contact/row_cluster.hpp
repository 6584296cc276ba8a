// SPDX-License-Identifier: BSD-3-Clause
// Rows that share nodes: their pseudo-inverse, and the projection that holds them.
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
  std::size_t row = 0;      ///< among the local rows of its TraceRows
  std::int64_t number = 0;  ///< over all ranks
  std::vector<Share> shares;

  /// Of a displacement.
  double of(std::span<const double> u, std::size_t dim) const {
    double sum = 0.0;
    for (const Share& share : shares)
      for (std::size_t c = 0; c < dim; ++c)
        sum += share.coefficient[c] * u[static_cast<std::size_t>(share.node) * dim + c];
    return sum;
  }
};

/// C⁺ = Cᵀ (C Cᵀ)⁺ for rows C, with the sparse factor of C Cᵀ on every rank: it is no larger than a contact
/// surface. Rows may depend on each other.
class RowCluster final : public HeldRows {
 public:
  /// Keeps the factor of dependent rows finite. What it falsifies of independent ones (this over the smallest
  /// eigenvalue of the scaled C Cᵀ) is squared by a step of refinement.
  static constexpr double shift = 1e-12;

  /// `rows`: those this rank owns, at wide nodes only. Collective. The part has to outlive it.
  RowCluster(const Part& part, const WideNodes& nodes, std::vector<ClusterRow> rows);
  ~RowCluster() override;

  std::span<const ClusterRow> rows() const noexcept { return rows_; }
  /// (C Cᵀ)⁺ b; b(row) is asked for the owned rows. The same bits on every rank. Collective.
  template <class Value>
  Vector solve(const Value& b) const {
    Vector all(numbers_.size(), 0.0);
    for (const ClusterRow& row : rows_) all[position(row.number)] = b(row);
    solve_gathered(all);
    return all;
  }
  /// Where the row of that number stands in what solve() returns.
  std::size_t position(std::int64_t number) const noexcept;
  /// y += Cᵀ z, z from solve(); consistent. Collective.
  void add_transpose(std::span<const double> z, std::span<double> y) const;
  /// x −= C⁺ C x. Collective.
  void project(std::span<double> x) const override;

 private:
  void solve_gathered(Vector& b) const;

  const Part* part_;
  WideNodes nodes_;
  std::vector<ClusterRow> rows_;
  std::vector<std::int64_t> numbers_;  ///< of the rows of all ranks, ascending
  struct Factor;
  std::unique_ptr<const Factor> factor_;
};

}  // namespace kacanov
