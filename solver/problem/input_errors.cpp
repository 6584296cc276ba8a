// SPDX-License-Identifier: BSD-3-Clause
// Suggestions for mistyped words by edit distance.
#include "problem/input_errors.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace kacanov {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string closest_word(const std::string& word, std::span<const std::string> candidates) {
  std::string best;
  // At least two edits, because a transposition counts as two.
  std::size_t least = (word.size() > 2 ? std::max<std::size_t>(2, word.size() / 3) : 1) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace kacanov
