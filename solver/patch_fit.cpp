// SPDX-License-Identifier: BSD-3-Clause
// Polynomials fitted to samples round corners, by normal equations that add up over ranks.
#include "patch_fit.hpp"

#include <cmath>

namespace kacanov {
namespace {

// Added to the diagonal, in the weight of a sample. Linear terms are left alone. Quadratic ones of a patch at
// the boundary, of a few elements, would extrapolate noise: 11 % too much at a hole with 1e-4, 1 % off so.
constexpr double hold_linear = 1e-9, hold_quadratic = 0.1;

}  // namespace

Monomials::Monomials(int dim, int order) : dim_(dim), quadratic_(order > 1) {
  count_ = quadratic_ ? (dim_ + 1) * (dim_ + 2) / 2 : dim_ + 1;
}

PatchFits::PatchFits(std::size_t centres, const Monomials& monomials)
    : monomials_(monomials),
      pairs_(monomials.count() * (monomials.count() + 1) / 2),
      width_(pairs_ + values * monomials.count()),
      sums_(centres * width_, 0.0) {}

void PatchFits::solve() {
  monomials_.with_count([&](auto count) { solve_of<count()>(); });
}

template <std::size_t n>
void PatchFits::solve_of() {
  std::array<std::array<double, n>, n> l;
  for (std::size_t centre = 0; centre * width_ < sums_.size(); ++centre) {
    if (!has(centre)) continue;
    const double* sum = &sums_[centre * width_];
    double* side = &sums_[centre * width_ + pairs_];
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) l[j][i] = *sum++;
    for (std::size_t i = 1; i < n; ++i) l[i][i] += i < monomials_.linear() ? hold_linear : hold_quadratic;
    // Cholesky, then both triangles.
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double rest = l[i][j];
        for (std::size_t k = 0; k < j; ++k) rest -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(rest) : rest / l[j][j];
      }
      for (std::size_t v = 0; v < values; ++v) {
        double rest = side[i * values + v];
        for (std::size_t k = 0; k < i; ++k) rest -= l[i][k] * side[k * values + v];
        side[i * values + v] = rest / l[i][i];
      }
    }
    for (std::size_t i = n; i-- > 0;)
      for (std::size_t v = 0; v < values; ++v) {
        double rest = side[i * values + v];
        for (std::size_t k = i + 1; k < n; ++k) rest -= l[k][i] * side[k * values + v];
        side[i * values + v] = rest / l[i][i];
      }
  }
}

}  // namespace kacanov
