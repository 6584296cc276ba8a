// SPDX-License-Identifier: BSD-3-Clause
// Pressures of averaged tr ε as distributed rows, around corners or element by element (B-bar).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include <kacanov/scatterer.hpp>
#include "multigrid/multigrid_body.hpp"
#include "operator/nodal_pressure.hpp"

namespace kacanov {

/// Returns whether elements of this body, in 3D, average over themselves.
bool averages_over_elements(const Body& body) noexcept;

/// Like corner_means(): one entry per element that averages, shared by all its corners.
CornerMeans element_means(const Body& body);

/// Like make_corner_rows(): one row per entry, on no other rank. Collective.
CornerRows element_rows(const CornerMeans& means, const Body& body, const IndexMap& nodes);

/// B of these elements, hexahedra: ∫ ∂_i N_a over each element, 24 numbers.
class ElementChanges {
 public:
  /// The arguments must outlive it.
  ElementChanges(const Body& body, const CornerMeans& means, int threads);
  /// q = B x, with one value per entry.
  void volume_change(std::span<const float> x, std::span<float> q) const;
  /// y += Bᵀ p.
  void add_force(std::span<const float> p, std::span<float> y) const;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t nodes = 8;

  int threads_;
  std::vector<std::int32_t> node_;   ///< entries × 8
  std::vector<float> change_;        ///< entries × 8 × 3
  std::vector<std::int64_t> first_;  ///< size nodes + 1, index into use_
  std::vector<std::int32_t> use_;    ///< indices into node_ of each node's uses
};

/// The rows of CornerRows. An operator has entries (CornerMeans), with copies on all ranks with elements
/// there.
class PressureRows {
 public:
  /// Collective.
  explicit PressureRows(const MultigridBody& body);

  /// Number of rows of this rank.
  std::size_t rows() const noexcept { return rows_->node.size(); }
  /// Local node of a row: its position, or a node near the centre of its patch.
  std::int32_t node(std::size_t row) const { return rows_->node[row]; }
  /// ranks + 1 entries: first global number of each rank's rows.
  std::span<const std::int64_t> starts() const noexcept { return rows_->map.starts; }
  /// Global number of an entry's row.
  std::int64_t number(std::size_t entry) const { return rows_->map.number(rows_->of_entry[entry]); }
  const CornerMeans& means() const noexcept { return means_; }
  /// Volume over k0 of each row: C's diagonal.
  std::span<const double> compliance() const noexcept { return compliance_; }

  /// rows = sums of the entries over all ranks. Collective.
  void sum(std::span<const float> entries, std::span<double> rows);
  /// Copies the values of rows to the entries. Collective.
  void spread(std::span<const double> rows, std::span<float> entries);
  std::size_t bytes() const noexcept;

 private:
  CornerMeans means_;
  std::unique_ptr<const CornerRows> rows_;  ///< the scatterer points to its map
  Scatterer<double> scatterer_;
  std::vector<double> compliance_, values_;  ///< values_: of rows and copies
};

}  // namespace kacanov
