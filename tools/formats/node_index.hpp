// SPDX-License-Identifier: BSD-3-Clause
// From the node numbers of a file, which may be sparse and unordered, to indices.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kacanov {

/// Nothing is stored where the numbers are consecutive, a table where they are dense, else a sorted list.
class NodeIndex {
 public:
  /// Takes the number of every node, in order; returns a number that occurs twice, if any.
  std::optional<std::int64_t> assign(std::span<const std::int64_t> tags);

  /// Index of the node with this number, −1 if there is none.
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
