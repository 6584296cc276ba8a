// SPDX-License-Identifier: BSD-3-Clause
// The displacement–pressure form on the trilinear functions of a leaf, computed from its moments.
#include "multigrid/leaf_form.hpp"

#include <algorithm>

namespace kacanov {
namespace {

/// Sums of moments that are integrals of two trilinear functions: along each axis the product of their values
/// (l₀², l₀l₁, l₁²), the value of one where the other is differentiated (l₀, l₁), and 1 where both are.
using Products = std::array<double, 216>;

Products products_of(const Moments& moments) {
  // From l₀², l₀l₁, l₁²: l₀ = l₀² + l₀l₁, l₁ = l₀l₁ + l₁²; l₀² + 2 l₀l₁ + l₁² = 1.
  const auto spread = [](double a, double b, double c) {
    return std::array<double, 6>{a, b, c, a + b, b + c, a + 2.0 * b + c};
  };
  std::array<double, 54> last;  // 3 × 3 × 6
  for (std::size_t ij = 0; ij < 9; ++ij) {
    const double* m = &moments[3 * ij];
    const auto v = spread(m[0], m[1], m[2]);
    for (std::size_t k = 0; k < 6; ++k) last[6 * ij + k] = v[k];
  }
  std::array<double, 108> both;  // 3 × 6 × 6
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 6; ++k) {
      const double* m = &last[18 * i + k];
      const auto v = spread(m[0], m[6], m[12]);
      for (std::size_t j = 0; j < 6; ++j) both[36 * i + 6 * j + k] = v[j];
    }
  Products of;
  for (std::size_t jk = 0; jk < 36; ++jk) {
    const auto v = spread(both[jk], both[36 + jk], both[72 + jk]);
    for (std::size_t i = 0; i < 6; ++i) of[36 * i + jk] = v[i];
  }
  return of;
}

/// Index in Products of the integral of corner functions i and j, differentiated along a and b (3: not), and
/// its sign, for derivatives with respect to ξ.
struct Term {
  std::uint8_t at = 0;
  std::int8_t sign = 1;
};

constexpr Term term_of(std::size_t i, std::size_t j, std::size_t a, std::size_t b) {
  std::size_t at = 0;
  int sign = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = i >> k & 1, q = j >> k & 1;
    if (k == a && p == 0) sign = -sign;
    if (k == b && q == 0) sign = -sign;
    at = 6 * at + (k == a && k == b ? 5 : k == a ? 3 + q : k == b ? 3 + p : p + q);
  }
  return {static_cast<std::uint8_t>(at), static_cast<std::int8_t>(sign)};
}

constexpr auto leaf_terms = [] {
  std::array<Term, 1024> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = term_of(k >> 7, k >> 4 & 7, k >> 2 & 3, k & 3);
  return all;
}();

/// The terms of corners i and j.
struct Pair {
  const Term* terms;  ///< 4 × 4: differentiated along a, b
  Pair(std::size_t i, std::size_t j) : terms(&leaf_terms[(8 * i + j) << 4]) {}
  double operator()(const Products& of, std::size_t a, std::size_t b) const {
    const Term& term = terms[4 * a + b];
    return term.sign * of[term.at];
  }
};

}  // namespace

LeafForm::LeafForm(const LeafMoments& moments, const StiffnessMoments* stiffness, double length) {
  const double slope = 1.0 / length;
  const Products shear = products_of(moments.shear), bulk = products_of(moments.bulk),
                 volume = products_of(moments.volume), compliance = products_of(moments.compliance);
  const double total_shear = shear[215], total_volume = volume[215];
  std::array<double, 64> mass{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j) {
      const Pair pair(i, j);
      Block& block = block_[8 * i + j];
      block.fill(0.0);
      double trace = 0.0;
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t t = 0; t < 3; ++t) {
          const double rt = slope * slope * pair(shear, r, t);  // g ∂_r φ_i ∂_t φ_j
          block[t * 4 + r] += rt;
          block[r * 4 + t] += slope * slope * pair(bulk, r, t) - 2.0 / 3.0 * rt;
          if (r == t) trace += rt;
        }
      for (std::size_t r = 0; r < 3; ++r) {
        block[r * 4 + r] += trace;
        block[r * 4 + 3] = slope * pair(volume, r, 3);
        block[12 + r] = slope * pair(volume, 3, r);
      }
      block[15] = -pair(compliance, 3, 3);
      mass[8 * i + j] = mass[8 * j + i] = pair(volume, 3, 3);
    }
  if (total_volume > 0.0 && total_shear > 0.0) add_stabilisation(mass, 0.5 * total_volume / total_shear);
  if (stiffness != nullptr) add_stiffness(*stiffness);
  mirror();
}

void LeafForm::add_stabilisation(const std::array<double, 64>& mass, double softness) {
  std::array<double, 8> share{};
  double volume = 0.0;
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) share[i] += mass[8 * i + j];
    volume += share[i];
  }
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j)
      block_[8 * i + j][15] -= softness * (mass[8 * i + j] - share[i] * share[j] / volume);
}

void LeafForm::add_stiffness(const StiffnessMoments& stiffness) {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j) {
      std::size_t at = 0;
      for (std::size_t k = 0; k < 3; ++k) at = 3 * at + (i >> k & 1) + (j >> k & 1);
      Block& block = block_[8 * i + j];
      for (std::size_t r = 0, k = 0; r < 3; ++r)
        for (std::size_t t = r; t < 3; ++t, ++k) {
          block[4 * r + t] += stiffness[k][at];
          if (t != r) block[4 * t + r] += stiffness[k][at];
        }
    }
}

void LeafForm::mirror() {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t t = 0; t < 4; ++t) block_[8 * i + j][4 * r + t] = block_[8 * j + i][4 * t + r];
}

}  // namespace kacanov
