// SPDX-License-Identifier: BSD-3-Clause
// Ascending indices, most of them consecutive, stored as runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kacanov {

/// Ascending indices stored as runs of consecutive ones: at most eight bytes per index, and almost nothing if
/// the elements of a part are contiguous in the mesh.
struct IndexRuns {
  struct Run {
    std::int32_t first = 0;     ///< index
    std::int32_t position = 0;  ///< position of `first` in the list
  };
  std::vector<Run> runs;
  std::int32_t count = 0;

  std::size_t size() const noexcept { return static_cast<std::size_t>(count); }
  /// Appends `index`, which must exceed all indices in the list.
  void push_back(std::int32_t index) {
    if (runs.empty() || index - runs.back().first != count - runs.back().position)
      runs.push_back({index, count});
    ++count;
  }
  std::int32_t operator[](std::size_t position) const noexcept {
    const auto run = std::upper_bound(runs.begin(), runs.end(), position,
                                      [](std::size_t p, const Run& r) {
                                        return p < static_cast<std::size_t>(r.position);
                                      }) -
                     1;
    return run->first + static_cast<std::int32_t>(position) - run->position;
  }
  /// Returns the position of `index`, which must be in the list.
  std::int32_t position_of(std::int32_t index) const noexcept {
    const auto run = std::upper_bound(runs.begin(), runs.end(), index,
                                      [](std::int32_t i, const Run& r) { return i < r.first; }) -
                     1;
    return run->position + index - run->first;
  }
};

}  // namespace kacanov
