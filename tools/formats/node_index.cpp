// SPDX-License-Identifier: BSD-3-Clause
// Maps node numbers by a table if they are dense, by a sorted list otherwise.
#include "formats/node_index.hpp"

#include <algorithm>

namespace kacanov {

std::optional<std::int64_t> NodeIndex::assign(std::span<const std::int64_t> tags) {
  *this = NodeIndex();
  if (tags.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(tags.begin(), tags.end());
  first_ = *low;
  last_ = *high;
  const auto count = static_cast<std::uint64_t>(tags.size());
  const std::uint64_t range = static_cast<std::uint64_t>(last_) - static_cast<std::uint64_t>(first_);
  if (range == count - 1 && std::is_sorted(tags.begin(), tags.end()) &&
      std::adjacent_find(tags.begin(), tags.end()) == tags.end())
    return std::nullopt;
  if (range / 4 < count) {
    table_.assign(static_cast<std::size_t>(range) + 1, -1);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      std::int32_t& place = table_[tags[i] - first_];
      if (place >= 0) return tags[i];
      place = static_cast<std::int32_t>(i);
    }
    return std::nullopt;
  }
  sorted_.reserve(tags.size());
  for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], static_cast<std::int32_t>(i));
  std::sort(sorted_.begin(), sorted_.end());
  const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                        [](const auto& a, const auto& b) { return a.first == b.first; });
  return twice == sorted_.end() ? std::nullopt : std::optional(twice->first);
}

std::int32_t NodeIndex::find_sorted(std::int64_t tag) const {
  const auto place =
      std::lower_bound(sorted_.begin(), sorted_.end(), std::pair<std::int64_t, std::int32_t>(tag, 0));
  return place != sorted_.end() && place->first == tag ? place->second : -1;
}

}  // namespace kacanov
