// SPDX-License-Identifier: BSD-3-Clause
// The contact nodes of one active set: how they close, and which reactions a nodal force stands for.
#pragma once

#include <span>
#include <vector>

#include "contact/active_set.hpp"
#include "contact/multi_node_friction.hpp"

namespace kacanov {

/// Nodes with held rows. Several contact entries may meet in a node, as in the edge between a floor and a
/// wall. Normals come first: friction acts only in directions that they leave free, so that no row is held
/// twice. What is left over is shared by the entries in proportion to what each can bear. The reaction of a
/// point that slides under Coulomb friction acts along ν + μ ŝ. Nodes of wide points are left to RowCluster,
/// and their sliding friction to WideSliding.
class HeldNodes {
 public:
  HeldNodes(const Part& part, const ActiveSet& set, const ContactState& state);

  /// Whether the reactions of any rank's node are oblique: the operator of the step is not symmetric then.
  bool oblique() const noexcept { return oblique_; }
  /// The displacements of the nodes that close the gaps and undo the slip of held rows; the rest of `delta`
  /// stays. Returns the largest component, over all ranks. Collective.
  double close(std::span<double> delta) const;
  /// Takes from the nodal forces the sliding friction of the reactions they call for. What is left of them in
  /// free directions is out of balance. Collective.
  void subtract_sliding(std::span<double> force) const;
  /// λ_n and λ_t of held rows for nodal forces, friction of those that slide under Coulomb's law included; at
  /// wide points where any of them slides. Collective.
  void reactions(std::span<const double> force, ContactValues& lambda) const;

 private:
  struct Row {
    std::int32_t point = 0, component = 0;  ///< −1: normal
    Vector3 react{};                        ///< multiplier times mass = react · force
  };
  struct Node {
    std::int32_t node = 0;
    std::size_t first = 0, last = 0;  ///< rows
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
