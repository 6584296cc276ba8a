// SPDX-License-Identifier: BSD-3-Clause
// A selection of contact rows scaled by √mass, to be penalised, held or pinned.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contact/multi_node_contact.hpp"
#include "contact/row_cluster.hpp"
#include "linear/preconditioner.hpp"
#include "linear/space.hpp"

namespace kacanov {

/// The selected traces of a contact point.
struct TraceChoice {
  bool normal = false, tangential = false;
  bool operator==(const TraceChoice&) const = default;
};

/// Rows of D^½ C for a selection of traces over the local points, owned ones first; D is the lumped mass.
/// Rows of a single node have their own pseudo-inverse; multi-node rows, and rows that share nodes with them,
/// have a joint one (RowCluster).
class TraceRows {
 public:
  /// `choice` has one entry per point of part.contact. Throws InputError if a node has more than nine
  /// single-node rows. Collective.
  TraceRows(const Part& part, std::span<const TraceChoice> choice);

  std::size_t owned() const noexcept { return owned_; }
  /// Global numbers of the owned rows, independent of the partition.
  std::span<const std::int64_t> index() const noexcept { return std::span(index_).first(owned_); }
  std::int64_t total() const noexcept { return total_; }
  /// √mass of the owned rows.
  std::span<const double> root_mass() const noexcept { return root_mass_; }

  /// Holds every row in `space`. Collective.
  void hold_in(Space& space) const;
  /// y = Cᵀ D^½ x (overwrites), x owned rows; consistent. Collective.
  void transpose(std::span<const double> x, std::span<double> y) const;
  /// x = D^½ C y, owned rows.
  void apply(std::span<const double> y, std::span<double> x) const;
  /// y = (D^½ C)⁺ x; consistent. `x` holds the owned rows or all local ones. Collective.
  void lift(std::span<const double> x, std::span<double> y) const;
  /// x = ((D^½ C)⁺)ᵀ y, for as many rows as `x` has: the owned ones or all local ones. Collective.
  void lift_transpose(std::span<const double> y, std::span<double> x) const;
  /// Number of rows of all local points: owned ones, then those of ghosts.
  std::size_t local() const noexcept { return index_.size(); }
  /// Returns the diagonal blocks of r CᵀDC for owned nodes (theory: augmented-lagrangian). Collective.
  std::vector<NodeBlock> penalty_blocks(double r) const;
  /// Returns blocks that pin the rows' directions in a preconditioner (theory: pinning); `diagonal`: that of
  /// the operator. Collective.
  std::vector<NodeBlock> pinning_blocks(std::span<const float> diagonal) const;

 private:
  struct Group {  ///< single-node rows of one node
    std::int32_t node = 0;
    std::size_t first = 0;  ///< index of its first row
    int rows = 0;
    std::array<Vector3, 9> row{};      ///< scaled by √mass
    std::array<Vector3, 9> inverse{};  ///< columns of the pseudo-inverse
    bool in_cluster = false;
  };
  void add_narrow(std::size_t point, std::span<const Vector3> rows);
  void invert(Group& group) const;
  /// Multi-node rows and the single-node rows at their nodes; null if no rank has multi-node rows. Created on
  /// first use, because blocks and products do not need its factor. Collective.
  const std::shared_ptr<const RowCluster>& cluster() const;
  std::vector<NodeBlock> narrow_blocks(double r) const;
  std::vector<NodeBlock> wide_blocks(double r) const;

  const Part* part_;
  WideNodes wide_;
  std::vector<Group> groups_;  ///< owned first
  std::size_t owned_groups_ = 0, owned_ = 0;
  std::vector<ClusterRow> wide_rows_;  ///< owned
  bool any_wide_ = false;              ///< whether any rank has multi-node rows
  mutable std::shared_ptr<const RowCluster> cluster_;
  std::vector<std::int64_t> index_;
  std::vector<double> root_mass_;
  std::int64_t total_ = 0;
  std::string crowded_;  ///< error message for a node with too many rows; otherwise empty
};

}  // namespace kacanov
