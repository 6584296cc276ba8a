// SPDX-License-Identifier: BSD-3-Clause
// Pressures of elements that average tr ε element by element (B-bar), in the format of corner pressures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/corner_means.hpp>
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

}  // namespace kacanov
