// SPDX-License-Identifier: BSD-3-Clause
// The pressures at corners round which tr ε is averaged, as rows over the ranks.
#include "multigrid/corner_pressures.hpp"

#include <algorithm>

namespace kacanov {

CornerPressures::CornerPressures(const MultigridBody& body)
    : nodes_(body.node_map), means_(corner_means(body.body)), width_(corner_moduli(body.body).size()) {
  const std::size_t owned = body.owned_nodes();
  std::vector<std::int32_t> has(body.nodes() * width_, 0);
  const auto place = [&](std::size_t entry) {
    return static_cast<std::size_t>(means_.node[entry]) * width_ +
           static_cast<std::size_t>(means_.modulus[entry]);
  };
  for (std::size_t e = 0; e < means_.size(); ++e) has[place(e)] = 1;
  nodes_->sum(has, static_cast<int>(width_));
  std::vector<std::int64_t> number(has.size(), -1);
  for (std::size_t k = 0; k < owned * width_; ++k) {
    if (has[k] == 0) continue;
    number[k] = static_cast<std::int64_t>(node_.size());
    node_.push_back(static_cast<std::int32_t>(k / width_));
    modulus_.push_back(static_cast<std::int32_t>(k % width_));
  }
  const std::int64_t first = nodes_->sum_below(static_cast<std::int64_t>(node_.size()));
  for (std::int64_t& n : number)
    if (n >= 0) n += first;
  nodes_->forward(number, static_cast<int>(width_));
  for (std::size_t e = 0; e < means_.size(); ++e) {
    number_.push_back(number[place(e)]);
    const std::int64_t row = number_.back() - first;
    row_.push_back(row >= 0 && row < static_cast<std::int64_t>(rows()) ? static_cast<std::int32_t>(row) : -1);
  }
  if (nodes_->ranks > 1) {
    of_node_.assign(has.size(), 0.0);
    for (const std::int32_t node : nodes_->shared)
      for (std::size_t k = 0; k < width_; ++k) shared_.push_back(static_cast<std::size_t>(node) * width_ + k);
  }
  std::vector<double> change(means_.size()), volume(means_.size());
  reference::corner_changes(body.body, means_, std::vector<double>(body.unknowns(), 0.0), change, volume);
  const std::vector<float> share(volume.begin(), volume.end());
  compliance_.resize(rows());
  sum(share, compliance_);
  for (std::size_t r = 0; r < rows(); ++r) compliance_[r] /= means_.moduli[modulus_[r]];
}

void CornerPressures::sum(std::span<const float> entries, std::span<double> rows) {
  std::fill(rows.begin(), rows.end(), 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e)
    if (row_[e] >= 0) rows[row_[e]] = static_cast<double>(entries[e]);
  if (of_node_.empty()) return;
  for (const std::size_t place : shared_) of_node_[place] = 0.0;
  for (std::size_t e = 0; e < entries.size(); ++e)
    of_node_[static_cast<std::size_t>(means_.node[e]) * width_ +
             static_cast<std::size_t>(means_.modulus[e])] = static_cast<double>(entries[e]);
  nodes_->sum(of_node_, static_cast<int>(width_));
  for (std::size_t r = 0; r < rows.size(); ++r)
    rows[r] = of_node_[static_cast<std::size_t>(node_[r]) * width_ + static_cast<std::size_t>(modulus_[r])];
}

void CornerPressures::spread(std::span<const double> rows, std::span<float> entries) {
  for (std::size_t e = 0; e < entries.size(); ++e)
    if (row_[e] >= 0) entries[e] = static_cast<float>(rows[row_[e]]);
  if (of_node_.empty()) return;
  for (std::size_t r = 0; r < rows.size(); ++r)
    of_node_[static_cast<std::size_t>(node_[r]) * width_ + static_cast<std::size_t>(modulus_[r])] = rows[r];
  nodes_->forward(of_node_, static_cast<int>(width_));
  for (std::size_t e = 0; e < entries.size(); ++e)
    entries[e] = static_cast<float>(of_node_[static_cast<std::size_t>(means_.node[e]) * width_ +
                                             static_cast<std::size_t>(means_.modulus[e])]);
}

std::size_t CornerPressures::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(node_) + size(modulus_) + size(number_) + size(row_) + size(compliance_) + size(of_node_) +
         size(shared_) + size(means_.node) + size(means_.modulus) + size(means_.of_element);
}

}  // namespace kacanov
