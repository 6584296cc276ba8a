// SPDX-License-Identifier: BSD-3-Clause
// Coulomb friction of sliding points at the nodes of multi-node rows (theory: coulomb-newton).
#pragma once

#include <memory>
#include <vector>

#include "contact/active_set.hpp"
#include "contact/row_cluster.hpp"

namespace kacanov {

/// Reactions x of held rows R at the nodes of multi-node points, where those of sliding points act along the
/// rows Q of ν + μ ŝ: R f = R Qᵀ x for a nodal force f, solved with a sparse factor of R Qᵀ on every rank.
/// Needs no factor and no messages if no such point slides.
class WideSliding {
 public:
  /// Collective. The part must outlive it.
  WideSliding(const Part& part, const ActiveSet& set);
  ~WideSliding();

  /// Whether a point slides on any rank.
  bool any() const noexcept { return factor_ != nullptr; }
  /// force −= (Q − R)ᵀ x; consistent. Collective.
  void subtract(std::span<double> force) const;
  /// Computes λ of the held rows. Collective.
  void reactions(std::span<const double> force, ContactValues& lambda) const;

 private:
  struct Row {
    std::size_t point = 0;
    int component = -1;  ///< −1: normal
    bool owned = false;
    ClusterRow held, slides;  ///< R and Q − R; of owned points
  };
  struct Factor;
  void add_point(const ActiveSet& set, std::size_t point);
  void factorise();
  std::vector<double> solve(std::span<const double> force) const;
  std::size_t position(std::int64_t number) const noexcept;

  const Part* part_;
  WideNodes nodes_;
  std::vector<Row> rows_;
  std::vector<std::int64_t> numbers_;  ///< rows of all ranks, ascending
  std::unique_ptr<const Factor> factor_;
};

}  // namespace kacanov
