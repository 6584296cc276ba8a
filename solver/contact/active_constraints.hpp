// SPDX-License-Identifier: BSD-3-Clause
// Active constraints at the contact nodes: gap closing, and contact reactions from nodal forces.
#pragma once

#include <span>
#include <vector>

#include "contact/active_set.hpp"
#include "contact/multi_node_friction.hpp"

namespace kacanov {

/// Nodes with held rows. Where several contact entries meet, normals take precedence: friction acts only in
/// directions they leave free, shared in proportion to the bounds, so no row is held twice. Coulomb sliding
/// makes a reaction oblique: ν + μ ŝ. RowCluster and WideSliding handle nodes of multi-node points.
class HeldNodes {
 public:
  HeldNodes(const Part& part, const ActiveSet& set, const ContactState& state);

  /// Whether the reactions at a node of any rank are oblique; the operator of the step is then nonsymmetric.
  bool oblique() const noexcept { return oblique_; }
  /// Sets in `delta` the nodal displacements that close the gaps and undo the slip of held rows; other
  /// entries are unchanged. Returns the largest component over all ranks. Collective.
  double close(std::span<double> delta) const;
  /// Subtracts from the nodal forces the sliding friction caused by their normal reactions. The remainder in
  /// free directions is the unbalanced force. Collective.
  void subtract_sliding(std::span<double> force) const;
  /// Computes λ_n and λ_t of held rows from nodal forces, including friction of rows that slide under
  /// Coulomb's law; at multi-node points only if one of them slides. Collective.
  void reactions(std::span<const double> force, ContactValues& lambda) const;

 private:
  struct Row {
    std::int32_t point = 0, component = 0;  ///< −1: normal
    Vector3 react{};                        ///< multiplier times mass = react · force
  };
  struct Node {
    std::int32_t node = 0;
    std::size_t first = 0, last = 0;  ///< range of its rows
    bool slides = false;
    Vector3 closing{};
    std::array<Vector3, 3> sliding{};  ///< force − sliding force = (I − sliding) force, by rows
  };
  void add_node(const ActiveSet& set, const ContactState& state, std::size_t first, std::size_t last);

  const Part* part_;
  WideSliding wide_;
  std::vector<Node> nodes_;
  std::vector<Row> rows_;
  bool oblique_ = false;
};

}  // namespace kacanov
