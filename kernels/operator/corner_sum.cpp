// SPDX-License-Identifier: BSD-3-Clause
// Sums over processes of what belongs to the corners round which tr ε is averaged.
#include "operator/corner_sum.hpp"

namespace kacanov {

template <class Real>
CornerSum<Real>::CornerSum(const CornerMeans& means, const IndexMap& nodes)
    : nodes_(&nodes), width_(means.moduli.size()) {
  if (nodes.ranks == 1) return;
  of_node_.assign(nodes.size() * width_, Real(0));
  std::vector<char> is_shared(nodes.size(), 0);
  for (const std::int32_t node : nodes.shared) is_shared[node] = 1;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const std::size_t node = means.node[i];
    if (is_shared[node] != 0)
      shared_.push_back({static_cast<std::int32_t>(i), node * width_ + means.modulus[i]});
  }
}

template <class Real>
void CornerSum<Real>::operator()(std::span<Real> entries) {
  if (of_node_.empty()) return;
  // A modulus may be at a node for another process alone: its place is zero here.
  for (const std::int32_t node : nodes_->shared)
    for (std::size_t k = 0; k < width_; ++k) of_node_[static_cast<std::size_t>(node) * width_ + k] = Real(0);
  for (const Shared& one : shared_) of_node_[one.place] = entries[one.entry];
  nodes_->sum(of_node_, static_cast<int>(width_));
  for (const Shared& one : shared_) entries[one.entry] = of_node_[one.place];
}

template class CornerSum<double>;
template class CornerSum<float>;

}  // namespace kacanov
