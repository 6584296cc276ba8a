// SPDX-License-Identifier: BSD-3-Clause
// Constraints and penalties of the C interface.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "c/handle.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

void require_index(std::int32_t index, std::size_t count, const std::string& name) {
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw Fault(KACANOV_ERROR_VALUE,
                name + ": expected 0 to " + std::to_string(count - 1) + ", got " + std::to_string(index));
}

k::NodeBlock checked_block(std::int32_t node, const double* value, std::size_t dim, const std::string& name) {
  k::NodeBlock block{node, {}};
  for (std::size_t i = 0; i < dim * dim; ++i) {
    if (!std::isfinite(value[i])) throw Fault(KACANOV_ERROR_VALUE, name + " is not finite");
    block.value[i] = value[i];
  }
  double largest = 0.0, skew = 0.0;
  for (std::size_t i = 0; i < dim; ++i) {
    if (value[i * dim + i] < 0.0)
      throw Fault(KACANOV_ERROR_VALUE, name + " has a negative entry on its diagonal");
    for (std::size_t j = 0; j < dim; ++j) {
      largest = std::max(largest, std::abs(value[i * dim + j]));
      skew = std::max(skew, std::abs(value[i * dim + j] - value[j * dim + i]));
    }
  }
  if (skew > 1e-10 * largest) throw Fault(KACANOV_ERROR_VALUE, name + " is not symmetric");
  return block;
}

}  // namespace

int kacanov_constrain(kacanov_operator* op, size_t count, const int32_t* unknown) {
  return alone(op, [&] {
    if (count > 0) require(unknown, "unknown");
    std::vector<std::int32_t> list;
    for (std::size_t i = 0; i < count; ++i) {
      require_index(unknown[i], op->unknowns(), "unknown[" + std::to_string(i) + "]");
      // Their rows are those of the identity already.
      const auto node = static_cast<std::int32_t>(unknown[i] / k::dimension(op->mesh.type));
      if (!std::binary_search(op->unit_nodes.begin(), op->unit_nodes.end(), node)) list.push_back(unknown[i]);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    op->constrained.swap(list);
  });
}

int kacanov_set_blocks(kacanov_operator* op, size_t count, const int32_t* node, const double* block) {
  return alone(op, [&] {
    if (count > 0) require(node, "node");
    if (count > 0) require(block, "block");
    const std::size_t dim = k::dimension(op->mesh.type);
    std::vector<k::NodeBlock> list;
    for (std::size_t i = 0; i < count; ++i) {
      require_index(node[i], op->mesh.node_count(), "node[" + std::to_string(i) + "]");
      list.push_back(checked_block(node[i], block + i * dim * dim, dim, "block[" + std::to_string(i) + "]"));
    }
    op->blocks.swap(list);
  });
}
