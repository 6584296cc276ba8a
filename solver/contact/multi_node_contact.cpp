// SPDX-License-Identifier: BSD-3-Clause
// Nodes of multi-node contact points, whose forces must be summed over the ranks.
#include "contact/multi_node_contact.hpp"

#include <algorithm>

namespace kacanov {

WideNodes::WideNodes(const Part& part) : part_(&part) {
  if (!part.wide_contact) return;
  std::vector<std::int32_t> mark(part.nodes(), 0);
  for (std::size_t i = 0; i < part.contact.size(); ++i)
    if (part.contact.is_wide(i))
      for (const RowEntry& entry : part.contact.entries(i)) mark[entry.node] = 1;
  part.node_map.sum(mark, 1);
  for (std::size_t n = 0; n < mark.size(); ++n)
    if (mark[n] > 0) nodes_.push_back(static_cast<std::int32_t>(n));

  static_cast<Communicator&>(map_) = part.node_map;
  map_.shared = part.node_map.shared;
  map_.neighbours = part.node_map.neighbours;
  const auto restrict_to_these = [this](std::vector<std::int32_t>& list) {
    std::erase_if(list, [this](std::int32_t node) { return !contains(node); });
    for (std::int32_t& node : list) node = static_cast<std::int32_t>(position(node));
  };
  restrict_to_these(map_.shared);
  for (auto& neighbour : map_.neighbours) restrict_to_these(neighbour.shared);
  std::erase_if(map_.neighbours, [](const auto& neighbour) { return neighbour.shared.empty(); });
}

std::size_t WideNodes::position(std::int32_t node) const noexcept {
  return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
}

bool WideNodes::contains(std::int32_t node) const noexcept {
  return std::binary_search(nodes_.begin(), nodes_.end(), node);
}

void WideNodes::add(std::span<double> forces, std::span<double> y) const {
  const std::size_t dim = part_->dim();
  map_.sum(forces, part_->dim());
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (std::size_t c = 0; c < dim; ++c)
      y[static_cast<std::size_t>(nodes_[k]) * dim + c] += forces[k * dim + c];
}

std::vector<NodeBlock> WideNodes::summed(std::vector<double> blocks) const {
  if (!part_->wide_contact) return {};
  const std::size_t dim = part_->dim();
  map_.sum(std::span<double>(blocks), part_->dim() * part_->dim());
  std::vector<NodeBlock> out;
  for (std::size_t k = 0; k < nodes_.size() && nodes_[k] < part_->owned_nodes(); ++k) {
    NodeBlock block{nodes_[k], {}};
    std::copy_n(&blocks[k * dim * dim], dim * dim, block.value.begin());
    out.push_back(block);
  }
  return out;
}

}  // namespace kacanov
