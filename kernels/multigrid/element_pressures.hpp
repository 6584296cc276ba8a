// SPDX-License-Identifier: BSD-3-Clause
// Pressures of elements that average tr ε each by itself (B-bar), as those of corners are held.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "operator/corner_rows.hpp"

namespace kacanov {

/// Whether elements of this body, in space, average over themselves.
bool averages_over_elements(const Body& body) noexcept;

/// As corner_means(): an entry for each element that averages, in which all its corners share.
CornerMeans element_means(const Body& body);

/// As make_corner_rows(): of every entry a row, which no other rank has. Collective.
CornerRows element_rows(const CornerMeans& means, const Body& body, const IndexMap& nodes);

/// B of these elements, hexahedra: ∫ ∂_i N_a over each, 24 numbers.
class ElementChanges {
 public:
  /// What is passed has to outlive it.
  ElementChanges(const Body& body, const CornerMeans& means, int threads);
  /// q = B x, of the entries.
  void volume_change(std::span<const float> x, std::span<float> q) const;
  /// y += Bᵀ p.
  void add_force(std::span<const float> p, std::span<float> y) const;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t nodes = 8;

  int threads_;
  std::vector<std::int32_t> node_;   ///< entries × 8
  std::vector<float> change_;        ///< entries × 8 × 3
  std::vector<std::int64_t> first_;  ///< nodes + 1, into
  std::vector<std::int32_t> use_;    ///< the index in node_ that is this one
};

}  // namespace kacanov
