// SPDX-License-Identifier: BSD-3-Clause
// The pressures at corners round which tr ε is averaged, as rows over the ranks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// A row for every corner and bulk modulus that some rank averages, owned by the rank of the node. An
/// operator has entries (CornerMeans), with copies on all ranks that have elements there.
class CornerPressures {
 public:
  /// The body's node map has to outlive it. Collective.
  explicit CornerPressures(const MultigridBody& body);

  /// This rank's.
  std::size_t rows() const noexcept { return node_.size(); }
  /// Local node of a row.
  std::int32_t node(std::size_t row) const { return node_[row]; }
  /// Number over all ranks of an entry's row.
  std::int64_t number(std::size_t entry) const { return number_[entry]; }
  const CornerMeans& means() const noexcept { return means_; }
  /// Volume over k0 of a row: C's diagonal.
  std::span<const double> compliance() const noexcept { return compliance_; }

  /// rows = the sums over all ranks of their shares of the entries. Collective.
  void sum(std::span<const float> entries, std::span<double> rows);
  /// The entries of rows. Collective.
  void spread(std::span<const double> rows, std::span<float> entries);
  std::size_t bytes() const noexcept;

 private:
  const IndexMap* nodes_;
  CornerMeans means_;
  std::size_t width_;
  std::vector<std::int32_t> node_, modulus_;  ///< of a row
  std::vector<std::int64_t> number_;          ///< of an entry
  std::vector<std::int32_t> row_;             ///< of an entry, −1 where another rank has it
  std::vector<double> compliance_, of_node_;
  std::vector<std::size_t> shared_;  ///< places of shared nodes in of_node_
};

}  // namespace kacanov
