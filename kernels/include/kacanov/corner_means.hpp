// SPDX-License-Identifier: BSD-3-Clause
// Where tetrahedra average their volume change: round the corners of the mesh, or over patches of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov {

/// The corners round which tr ε is averaged (theory: displacement-pressure), those of the elements whose law
/// asks for it and whose type has it: an entry for every corner, or for every patch of them
/// (Body::pressure_patch), and one for every bulk modulus that meets there, as pressure may jump between
/// materials. Ascending by place, then by modulus.
struct CornerMeans {
  bool has_patches = false;
  std::vector<std::int64_t> place;       ///< of every entry: local node, or number of the patch
  std::vector<std::int32_t> modulus;     ///< of every entry: which of `moduli`
  std::vector<double> moduli;            ///< k0, ascending
  std::vector<std::int32_t> of_element;  ///< elements × 4, −1 where an element has none; empty: none has

  std::size_t size() const noexcept { return place.size(); }
  double bulk(std::size_t entry) const noexcept { return moduli[modulus[entry]]; }
};

/// Whether this law averages on this type of element.
bool averages_at_corners(const Law& law, ElementType type) noexcept;
/// The bulk moduli of a body's laws that do, ascending: the same on all processes that know the same laws.
std::vector<double> corner_moduli(const Body& body);
CornerMeans corner_means(const Body& body);

namespace reference {

/// Adds up ∫ N tr ε(u) over the elements of a corner, N its linear function, into `change` (one an entry,
/// overwritten), and ∫ N into `volume` unless that is empty.
void corner_changes(const Body& body, const CornerMeans& means, std::span<const double> u,
                    std::span<double> change, std::span<double> volume);

}  // namespace reference
}  // namespace kacanov
