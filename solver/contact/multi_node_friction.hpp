// SPDX-License-Identifier: BSD-3-Clause
// Coulomb friction of points that slide at the nodes of wide rows (theory: coulomb-newton).
#pragma once

#include <memory>
#include <vector>

#include "contact/active_set.hpp"
#include "contact/row_cluster.hpp"

namespace kacanov {

/// The reactions x of held rows R at the nodes of wide points, of which those that slide act along the rows Q
/// of ν + μ ŝ: R f = R Qᵀ x for a nodal force f, by a sparse factor of R Qᵀ on every rank. Without factor and
/// messages where no such point slides.
class WideSliding {
 public:
  /// Collective. The part has to outlive it.
  WideSliding(const Part& part, const ActiveSet& set);
  ~WideSliding();

  /// Whether a point of any rank slides.
  bool any() const noexcept { return factor_ != nullptr; }
  /// force −= (Q − R)ᵀ x; consistent. Collective.
  void subtract(std::span<double> force) const;
  /// λ of the held rows. Collective.
  void reactions(std::span<const double> force, ContactValues& lambda) const;

 private:
  struct Row {
    std::size_t point = 0;
    int component = -1;  ///< −1: normal
    bool owned = false;
    ClusterRow held, slides;  ///< R, Q − R; of owned points
  };
  struct Factor;
  void add_point(const ActiveSet& set, std::size_t point);
  void factorise();
  std::vector<double> solve(std::span<const double> force) const;
  std::size_t position(std::int64_t number) const noexcept;

  const Part* part_;
  WideNodes nodes_;
  std::vector<Row> rows_;
  std::vector<std::int64_t> numbers_;  ///< of all ranks' rows, ascending
  std::unique_ptr<const Factor> factor_;
};

}  // namespace kacanov
