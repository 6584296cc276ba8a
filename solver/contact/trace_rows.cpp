// SPDX-License-Identifier: BSD-3-Clause
// A selection of contact rows scaled by √mass, to be penalised, held or pinned.
#include "contact/trace_rows.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>
#include "parallel/exchange.hpp"
#include "problem/dense.hpp"

namespace kacanov {
namespace {

/// Stiffness of a pinned direction relative to the node's diagonal entry.
constexpr double pinned_narrow = 1e3;
/// The same at the nodes of multi-node rows, which may move as long as their sums do not: soft for a single
/// node, stiff for many together.
constexpr double pinned_wide = 1.0;

/// y_node += Σ_k x_k row_k; take_rows() is the transpose.
template <class Rows>
void add_rows(const Rows& rows, std::size_t count, const double* x, double* y, std::size_t dim) {
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t c = 0; c < dim; ++c) y[c] += x[k] * rows[k][c];
}

template <class Rows>
void take_rows(const Rows& rows, std::size_t count, const double* y, double* x, std::size_t dim) {
  for (std::size_t k = 0; k < count; ++k) {
    x[k] = 0.0;
    for (std::size_t c = 0; c < dim; ++c) x[k] += rows[k][c] * y[c];
  }
}

/// Scales the blocks so that each has the trace `share` times the node's largest diagonal entry.
void scale_to(std::vector<NodeBlock>& blocks, double share, std::span<const float> diagonal,
              std::size_t dim) {
  for (auto& block : blocks) {
    double trace = 0.0, largest = 0.0;
    for (std::size_t c = 0; c < dim; ++c) {
      trace += block.value[c * dim + c];
      largest =
          std::max(largest, static_cast<double>(diagonal[static_cast<std::size_t>(block.node) * dim + c]));
    }
    if (trace > 0.0)
      for (double& v : block.value) v *= share * largest / trace;
  }
}

}  // namespace

TraceRows::TraceRows(const Part& part, std::span<const TraceChoice> choice) : part_(&part), wide_(part) {
  const std::size_t dim = part.dim();
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    const auto& point = part.contact[i];
    const auto entries = part.contact.entries(i);
    const std::size_t tangents = choice[i].tangential ? static_cast<std::size_t>(point.tangents) : 0,
                      rows = tangents + (choice[i].normal ? 1 : 0), first = index_.size();
    const auto coefficient = [&](std::size_t row, const RowEntry& entry) -> const Vector3& {
      return choice[i].normal ? row == 0 ? entry.trace : entry.tangent[row - 1] : entry.tangent[row];
    };
    if (rows == 0) continue;
    for (std::size_t k = 0; k < rows; ++k) {
      index_.push_back(3 * static_cast<std::int64_t>(part.contact_index[i]) + static_cast<std::int64_t>(k));
      if (i >= static_cast<std::size_t>(part.owned_contact)) continue;
      root_mass_.push_back(std::sqrt(point.mass));
      owned_ = index_.size();
    }
    std::array<Vector3, 3> narrow{};
    for (std::size_t k = 0; k < rows; ++k) {
      ClusterRow row{first + k, index_[first + k], {}};
      for (const RowEntry& entry : entries) {
        Vector3 scaled{};
        for (std::size_t c = 0; c < dim; ++c) scaled[c] = std::sqrt(point.mass) * coefficient(k, entry)[c];
        narrow[k] = scaled;
        if (entries.size() > 1) row.shares.push_back({entry.node, scaled});
      }
      if (entries.size() > 1) wide_rows_.push_back(std::move(row));
    }
    if (entries.size() == 1) add_narrow(i, std::span(narrow).first(rows));
  }
  refuse_together(crowded_, part.node_map);
  for (Group& group : groups_) invert(group);
  total_ = part.node_map.sum_all(static_cast<std::int64_t>(owned_));
  any_wide_ = part.wide_contact && part.node_map.any(!wide_rows_.empty());
  if (any_wide_)
    for (Group& group : groups_) group.in_cluster = wide_.contains(group.node);
}

/// Adds the rows of a single-node point after those of its node.
void TraceRows::add_narrow(std::size_t point, std::span<const Vector3> rows) {
  const std::int32_t node = part_->contact.entries(point).front().node;
  const std::size_t first = index_.size() - rows.size();
  if (groups_.empty() || groups_.back().node != node ||
      groups_.back().first + static_cast<std::size_t>(groups_.back().rows) != first)
    groups_.push_back({node, first, 0, {}, {}, false});
  if (point < static_cast<std::size_t>(part_->owned_contact)) owned_groups_ = groups_.size();
  auto& group = groups_.back();
  if (static_cast<std::size_t>(group.rows) + rows.size() > group.row.size())
    crowded_ = "contact: node " + std::to_string(part_->node_tag(node)) +
               " belongs to more than three contact surfaces";
  if (!crowded_.empty()) return;
  for (const Vector3& row : rows) group.row[group.rows++] = row;
}

void TraceRows::invert(Group& group) const {
  Eigen::MatrixXd a(group.rows, 3);
  for (int k = 0; k < group.rows; ++k)
    for (int c = 0; c < 3; ++c) a(k, c) = group.row[k][c];
  const Eigen::MatrixXd inverse = pseudo_inverse(a, 1e-8);
  for (int k = 0; k < group.rows; ++k)
    for (int c = 0; c < 3; ++c) group.inverse[k][c] = inverse(c, k);
}

const std::shared_ptr<const RowCluster>& TraceRows::cluster() const {
  if (!any_wide_ || cluster_) return cluster_;
  std::vector<ClusterRow> rows = wide_rows_;
  for (std::size_t g = 0; g < owned_groups_; ++g) {
    const Group& group = groups_[g];
    for (std::size_t k = 0; group.in_cluster && k < static_cast<std::size_t>(group.rows); ++k)
      rows.push_back({group.first + k, index_[group.first + k], {{group.node, group.row[k]}}});
  }
  cluster_ = std::make_shared<RowCluster>(*part_, wide_, std::move(rows));
  return cluster_;
}

void TraceRows::hold_in(Space& space) const {
  for (const auto& group : groups_)
    for (std::size_t k = 0; k < static_cast<std::size_t>(group.rows) && !group.in_cluster; ++k)
      space.hold(group.node, group.row[k]);
  if (any_wide_) space.hold(cluster());
}

void TraceRows::transpose(std::span<const double> x, std::span<double> y) const {
  const std::size_t dim = part_->dim();
  std::fill(y.begin(), y.end(), 0.0);
  for (std::size_t g = 0; g < owned_groups_; ++g)
    add_rows(groups_[g].row, groups_[g].rows, x.data() + groups_[g].first,
             y.data() + static_cast<std::size_t>(groups_[g].node) * dim, dim);
  part_->node_map.forward(y, part_->dim());
  if (!any_wide_) return;
  Vector wide = wide_.zeros(dim);
  for (const ClusterRow& row : wide_rows_)
    for (const auto& share : row.shares)
      for (std::size_t c = 0; c < dim; ++c)
        wide[wide_.position(share.node) * dim + c] += x[row.row] * share.coefficient[c];
  wide_.add(wide, y);
}

void TraceRows::apply(std::span<const double> y, std::span<double> x) const {
  const std::size_t dim = part_->dim();
  for (std::size_t g = 0; g < owned_groups_; ++g)
    take_rows(groups_[g].row, groups_[g].rows, y.data() + static_cast<std::size_t>(groups_[g].node) * dim,
              x.data() + groups_[g].first, dim);
  for (const ClusterRow& row : wide_rows_) x[row.row] = row.of(y, dim);
}

void TraceRows::lift(std::span<const double> x, std::span<double> y) const {
  const std::size_t dim = part_->dim();
  std::fill(y.begin(), y.end(), 0.0);
  for (const auto& group : groups_)
    if (group.first < x.size() && !group.in_cluster)
      add_rows(group.inverse, group.rows, x.data() + group.first,
               y.data() + static_cast<std::size_t>(group.node) * dim, dim);
  part_->node_map.forward(y, part_->dim());
  if (any_wide_)
    cluster()->add_transpose(cluster()->solve([&](const ClusterRow& row) { return x[row.row]; }), y);
}

void TraceRows::lift_transpose(std::span<const double> y, std::span<double> x) const {
  const std::size_t dim = part_->dim();
  for (const auto& group : groups_)
    if (group.first < x.size() && !group.in_cluster)
      take_rows(group.inverse, group.rows, y.data() + static_cast<std::size_t>(group.node) * dim,
                x.data() + group.first, dim);
  if (!any_wide_) return;
  const Vector z = cluster()->solve([&](const ClusterRow& row) { return row.of(y, dim); });
  for (const ClusterRow& row : cluster()->rows()) x[row.row] = z[cluster_->position(row.number)];
  for (std::size_t g = owned_groups_; g < groups_.size(); ++g)  // ghosts
    for (std::size_t k = 0; k < static_cast<std::size_t>(groups_[g].rows); ++k)
      if (const std::size_t row = groups_[g].first + k; groups_[g].in_cluster && row < x.size())
        x[row] = z[cluster_->position(index_[row])];
}

std::vector<NodeBlock> TraceRows::narrow_blocks(double r) const {
  const std::size_t dim = part_->dim();
  std::vector<NodeBlock> blocks;
  for (std::size_t g = 0; g < owned_groups_; ++g) {
    NodeBlock block{groups_[g].node, {}};
    for (std::size_t k = 0; k < static_cast<std::size_t>(groups_[g].rows); ++k)
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t j = 0; j < dim; ++j)
          block.value[i * dim + j] += r * groups_[g].row[k][i] * groups_[g].row[k][j];
    blocks.push_back(block);
  }
  return blocks;
}

std::vector<NodeBlock> TraceRows::wide_blocks(double r) const {
  if (!any_wide_) return {};
  const std::size_t dim = part_->dim();
  Vector sums = wide_.zeros(dim * dim);
  for (const ClusterRow& row : wide_rows_)
    for (const auto& share : row.shares)
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t j = 0; j < dim; ++j)
          sums[(wide_.position(share.node) * dim + i) * dim + j] +=
              r * share.coefficient[i] * share.coefficient[j];
  return wide_.summed(std::move(sums));
}

std::vector<NodeBlock> TraceRows::penalty_blocks(double r) const {
  std::vector<NodeBlock> blocks = narrow_blocks(r);
  const std::vector<NodeBlock> wide = wide_blocks(r);
  blocks.insert(blocks.end(), wide.begin(), wide.end());
  return blocks;
}

std::vector<NodeBlock> TraceRows::pinning_blocks(std::span<const float> diagonal) const {
  const std::size_t dim = part_->dim();
  std::vector<NodeBlock> blocks = narrow_blocks(1.0), wide = wide_blocks(1.0);
  scale_to(blocks, pinned_narrow, diagonal, dim);
  scale_to(wide, pinned_wide, diagonal, dim);
  blocks.insert(blocks.end(), wide.begin(), wide.end());
  return blocks;
}

}  // namespace kacanov
