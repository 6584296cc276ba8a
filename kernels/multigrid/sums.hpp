// SPDX-License-Identifier: BSD-3-Clause
// Vectors of unknowns, and vectorisable sums over them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace kacanov {

using Vector = std::vector<double>;

/// Σ term(i) over i < n with eight partial sums: the compiler may not reorder a single sum.
template <class Term>
double eight_sums(std::size_t n, const Term& term) {
  std::array<double, 8> s{};
  const std::size_t whole = n - n % 8;
  for (std::size_t i = 0; i < whole; i += 8)
    for (std::size_t k = 0; k < 8; ++k) s[k] += term(i + k);
  for (std::size_t i = whole; i < n; ++i) s[0] += term(i);
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

}  // namespace kacanov
