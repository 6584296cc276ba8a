// SPDX-License-Identifier: BSD-3-Clause
// Averages of the volume change of tetrahedra around mesh corners or over patches of corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov {

/// Corners around which tr ε is averaged (theory: displacement-pressure): those of elements whose law
/// requests it and whose type supports it. There is one entry per corner, or per patch of corners
/// (Body::pressure_patch), and per bulk modulus that meets there, because pressure may jump between
/// materials. Sorted by place, then by modulus.
struct CornerMeans {
  bool has_patches = false;
  std::vector<std::int64_t> place;    ///< per entry: local node, or number of the patch
  std::vector<std::int32_t> modulus;  ///< per entry: index into `moduli`
  std::vector<double> moduli;         ///< k0, ascending
  std::vector<std::int32_t>
      of_element;  ///< elements × 4, −1 for elements without averages; empty: no element has any

  std::size_t size() const noexcept { return place.size(); }
  double bulk(std::size_t entry) const noexcept { return moduli[modulus[entry]]; }
};

/// Returns whether this law averages on this element type.
bool averages_at_corners(const Law& law, ElementType type) noexcept;
/// Bulk moduli of the body's laws that average, ascending; the same on all ranks that have the same laws.
std::vector<double> corner_moduli(const Body& body);
CornerMeans corner_means(const Body& body);

namespace reference {

/// Sums ∫ N tr ε(u) over the elements of each corner, with N the corner's linear shape function, into
/// `change` (one per entry, overwritten), and ∫ N into `volume` unless that is empty.
void corner_changes(const Body& body, const CornerMeans& means, std::span<const double> u,
                    std::span<double> change, std::span<double> volume);

}  // namespace reference
}  // namespace kacanov
