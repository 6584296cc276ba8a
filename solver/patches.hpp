// SPDX-License-Identifier: BSD-3-Clause
// Polynomials round the corners of a part, fitted to what the quadrature points of the elements there have.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <kacanov/part.hpp>
#include "patch_fit.hpp"

namespace kacanov {

/// Superconvergent patch recovery (theory: nodal-stress), one batch of materials after the other: those of a
/// batch meet at no node, and each has polynomials of its own. Middles of edges have no patch.
class Patches {
 public:
  using Values = std::array<double, PatchFits::values>;

  /// Collective.
  explicit Patches(const Part& part);

  std::int32_t batches() const noexcept { return batches_; }
  bool is_in(std::size_t element, std::int32_t batch) const {
    return part_.law_of_element.empty() || batch_of_law_[part_.law_of_element[element]] == batch;
  }
  /// Nodes that are corners of elements.
  const std::vector<std::int32_t>& corners() const noexcept { return corners_; }

  /// Without samples yet.
  PatchFits fits(std::size_t sets) const;
  /// The samples of an element, for the patches of all its corners.
  void add(PatchFits& fits, std::size_t element, const Samples& samples) const;
  /// Adds up over the ranks that share a corner, and fits. Collective.
  void solve(PatchFits& fits) const;
  /// Whether the patch of a corner has had any sample, on any rank.
  bool has(const PatchFits& fits, std::size_t node) const { return fits.has(place(node)); }
  /// The polynomial of a corner, for as long as the fits live.
  struct Polynomial {
    const PatchFits* fits;
    const double* coefficients;
    Vector3 centre;
    double scale;
    Values operator()(const Vector3& position) const {
      return fits->evaluate(coefficients,
                            {scale * (position[0] - centre[0]), scale * (position[1] - centre[1]),
                             scale * (position[2] - centre[2])});
    }
  };
  Polynomial polynomial(const PatchFits& fits, std::size_t set, std::size_t node) const;

 private:
  std::size_t place(std::size_t node) const { return static_cast<std::size_t>(place_of_node_[node]); }

  const Part& part_;
  std::size_t nodes_of_element_, corners_of_element_;
  std::vector<std::int32_t> corners_, place_of_node_;
  /// One over the third root of the volume round each node, or over the square root of an area.
  std::vector<double> scale_;
  std::vector<std::int32_t> batch_of_law_;
  std::int32_t batches_ = 0;
};

}  // namespace kacanov
