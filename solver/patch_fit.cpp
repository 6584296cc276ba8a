// SPDX-License-Identifier: BSD-3-Clause
// Polynomials fitted to samples round corners, by normal equations that add up over ranks.
#include "patch_fit.hpp"

#include <algorithm>
#include <cmath>

#include "problem/vector3.hpp"

namespace kacanov {
namespace {

// Added to the diagonal, in the weight of a sample. Linear terms are left alone. Quadratic ones of a patch at
// the boundary, of a few elements, would extrapolate noise: 11 % too much at a hole with 1e-4, 1 % off so.
constexpr double hold_linear = 1e-9, hold_quadratic = 0.1;

/// Solves with both triangles for six sides at once.
template <std::size_t n>
void substitute(const std::array<std::array<double, n>, n>& l, double* side) {
  constexpr std::size_t values = Samples::values;
  const auto take_off = [&](std::size_t i, std::size_t k, double factor) {
    for (std::size_t v = 0; v < values; ++v) side[i * values + v] -= factor * side[k * values + v];
  };
  const auto divide = [&](std::size_t i) {
    for (std::size_t v = 0; v < values; ++v) side[i * values + v] /= l[i][i];
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) take_off(i, k, l[i][k]);
    divide(i);
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) take_off(i, k, l[k][i]);
    divide(i);
  }
}

}  // namespace

Monomials::Monomials(int dim, int order) : dim_(dim), quadratic_(order > 1) {
  count_ = quadratic_ ? (dim_ + 1) * (dim_ + 2) / 2 : dim_ + 1;
}

LinearSums::LinearSums(const Samples& samples, std::size_t sets)
    : count(static_cast<double>(samples.position.size())) {
  for (const Vector3& x : samples.position) mean = mean + (1.0 / count) * x;
  for (std::size_t q = 0; q < samples.position.size(); ++q) {
    const Vector3 away = samples.position[q] - mean;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j) square[i][j] += away[i] * away[j];
    for (std::size_t k = 0; k < sets; ++k) {
      const double* sample = samples.set[k] + q * Samples::values;
      for (std::size_t v = 0; v < Samples::values; ++v) {
        side[k][0][v] += sample[v];
        for (std::size_t i = 0; i < 3; ++i) side[k][1 + i][v] += away[i] * sample[v];
      }
    }
  }
}

PatchFits::PatchFits(std::size_t centres, const Monomials& monomials, std::size_t sets)
    : monomials_(monomials),
      sets_(sets),
      pairs_(monomials.count() * (monomials.count() + 1) / 2),
      width_(pairs_ + sets * values * monomials.count()),
      sums_(centres * width_, 0.0) {}

void PatchFits::add(std::size_t i, const Vector3& at, double scale, const Samples& samples) {
  monomials_.with_count([&](auto count) { add_of<count()>(&sums_[i * width_], at, scale, samples); });
}

void PatchFits::add(std::size_t i, const Vector3& at, double scale, const LinearSums& sums) {
  const Vector3 from = scale * (sums.mean - at);
  if (monomials_.count() == 4)
    add_of<4>(&sums_[i * width_], from, scale, sums);
  else
    add_of<3>(&sums_[i * width_], from, scale, sums);
}

template <std::size_t n>
void PatchFits::add_of(double* sum, const Vector3& at, double scale, const Samples& samples) const {
  constexpr std::size_t some = 8;  // samples at a time: sums are read and written once for all of them
  for (std::size_t first = 0; first < samples.position.size(); first += some) {
    const std::size_t count = std::min(some, samples.position.size() - first);
    std::array<std::array<double, Monomials::most>, some> p;
    for (std::size_t q = 0; q < count; ++q) p[q] = monomials_.at(scale * (samples.position[first + q] - at));
    double* entry = sum;
    for (std::size_t i = 0; i < n; entry += n - i, ++i) {
      std::array<double, n> row{};
      for (std::size_t q = 0; q < count; ++q)
        for (std::size_t j = 0; j < n; ++j) row[j] += p[q][i] * p[q][j];
      for (std::size_t j = i; j < n; ++j) entry[j - i] += row[j];
    }
    for (std::size_t k = 0; k < sets_; ++k) {
      const double* sample = samples.set[k] + first * values;
      for (std::size_t i = 0; i < n; ++i, entry += values) {
        std::array<double, values> side{};
        for (std::size_t q = 0; q < count; ++q)
          for (std::size_t v = 0; v < values; ++v) side[v] += p[q][i] * sample[q * values + v];
        for (std::size_t v = 0; v < values; ++v) entry[v] += side[v];
      }
    }
  }
}

template <std::size_t n>
void PatchFits::add_of(double* sum, const Vector3& from, double scale, const LinearSums& of) const {
  *sum++ += of.count;
  for (std::size_t j = 0; j + 1 < n; ++j) *sum++ += of.count * from[j];
  for (std::size_t i = 0; i + 1 < n; ++i)
    for (std::size_t j = i; j + 1 < n; ++j)
      *sum++ += scale * scale * of.square[i][j] + of.count * from[i] * from[j];
  for (std::size_t k = 0; k < sets_; ++k) {
    for (std::size_t v = 0; v < values; ++v) *sum++ += of.side[k][0][v];
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t v = 0; v < values; ++v)
        *sum++ += scale * of.side[k][1 + i][v] + from[i] * of.side[k][0][v];
  }
}

void PatchFits::solve() {
  monomials_.with_count([&](auto count) { solve_of<count()>(); });
}

template <std::size_t n>
void PatchFits::solve_of() {
  std::array<std::array<double, n>, n> l;
  for (std::size_t centre = 0; centre * width_ < sums_.size(); ++centre) {
    if (!has(centre)) continue;
    const double* sum = &sums_[centre * width_];
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) l[j][i] = *sum++;
    for (std::size_t i = 1; i < n; ++i) l[i][i] += i < monomials_.linear() ? hold_linear : hold_quadratic;
    // Cholesky, then both triangles.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double rest = l[i][j];
        for (std::size_t k = 0; k < j; ++k) rest -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(rest) : rest / l[j][j];
      }
    for (std::size_t k = 0; k < sets_; ++k) substitute(l, &sums_[centre * width_ + pairs_ + k * values * n]);
  }
}

}  // namespace kacanov
