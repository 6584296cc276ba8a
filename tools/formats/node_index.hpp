// SPDX-License-Identifier: BSD-3-Clause
// Maps the node numbers of a file, which may be sparse and unordered, to indices.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kacanov {

/// Stores nothing for consecutive numbers, a table for dense ones, and a sorted list otherwise.
class NodeIndex {
 public:
  /// Takes the numbers of all nodes, in order; returns a duplicate number, if any.
  std::optional<std::int64_t> assign(std::span<const std::int64_t> tags);

  /// Returns the index of the node with this number; −1 if there is none.
  std::int32_t find(std::int64_t tag) const {
    if (tag < first_ || tag > last_) return -1;
    if (!table_.empty()) return table_[tag - first_];
    return sorted_.empty() ? static_cast<std::int32_t>(tag - first_) : find_sorted(tag);
  }

 private:
  std::int32_t find_sorted(std::int64_t tag) const;

  std::int64_t first_ = 0, last_ = -1;
  std::vector<std::int32_t> table_;
  std::vector<std::pair<std::int64_t, std::int32_t>> sorted_;
};

}  // namespace kacanov
