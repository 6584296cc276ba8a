// SPDX-License-Identifier: BSD-3-Clause
// Polynomials fitted to samples round corners, by normal equations that add up over ranks.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include <kacanov/model.hpp>

namespace kacanov {

/// Monomials 1, x_i and, of order 2, x_i x_j; of a plane or of space.
class Monomials {
 public:
  static constexpr std::size_t most = 10;
  Monomials(int dim, int order);
  std::size_t count() const noexcept { return count_; }
  std::size_t linear() const noexcept { return 1 + dim_; }  ///< those of order 0 and 1
  std::array<double, most> at(const Vector3& x) const {
    std::array<double, most> value{1.0};
    for (std::size_t i = 0; i < dim_; ++i) value[1 + i] = x[i];
    if (!quadratic_) return value;
    std::size_t k = 1 + dim_;
    for (std::size_t i = 0; i < dim_; ++i)
      for (std::size_t j = i; j < dim_; ++j) value[k++] = x[i] * x[j];
    return value;
  }
  /// Calls work(std::integral_constant of count()), so that loops over monomials are of known length.
  template <class Work>
  decltype(auto) with_count(const Work& work) const {
    switch (count_) {
      case 3: return work(std::integral_constant<std::size_t, 3>());
      case 4: return work(std::integral_constant<std::size_t, 4>());
      case 6: return work(std::integral_constant<std::size_t, 6>());
      default: return work(std::integral_constant<std::size_t, most>());
    }
  }

 private:
  std::size_t dim_, count_;
  bool quadratic_;
};

/// Least squares round many centres at once, six values a sample.
class PatchFits {
 public:
  static constexpr std::size_t values = 6;
  PatchFits(std::size_t centres, const Monomials& monomials);

  /// `x`: from the centre, in units of the patch's size.
  void add(std::size_t centre, const Vector3& x, const double* sample) {
    const auto p = monomials_.at(x);
    monomials_.with_count([&](auto count) {
      constexpr std::size_t n = count();
      double* sum = &sums_[centre * width_];
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i; j < n; ++j) *sum++ += p[i] * p[j];
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t v = 0; v < values; ++v) *sum++ += p[i] * sample[v];
    });
  }
  /// The sums of centre i, to be added up over ranks.
  std::span<double> sums(std::size_t centre) noexcept {
    return std::span(sums_).subspan(centre * width_, width_);
  }
  std::size_t width() const noexcept { return width_; }
  /// Whether any sample came.
  bool has(std::size_t centre) const noexcept { return sums_[centre * width_] > 0.0; }
  /// Solves the normal equations of all centres in place. What too few samples leave open is kept small,
  /// the higher orders first.
  void solve();
  /// After solve(): the polynomial's values.
  std::array<double, values> evaluate(std::size_t centre, const Vector3& x) const {
    return evaluate(coefficients(centre), x);
  }
  /// The same where many values of one polynomial are wanted.
  const double* coefficients(std::size_t centre) const noexcept { return &sums_[centre * width_ + pairs_]; }
  std::array<double, values> evaluate(const double* coefficients, const Vector3& x) const {
    const auto p = monomials_.at(x);
    std::array<double, values> out{};
    monomials_.with_count([&](auto count) {
      for (std::size_t i = 0; i < count(); ++i)
        for (std::size_t v = 0; v < values; ++v) out[v] += p[i] * coefficients[i * values + v];
    });
    return out;
  }

 private:
  template <std::size_t n>
  void solve_of();

  Monomials monomials_;
  std::size_t pairs_, width_;
  std::vector<double> sums_;  ///< centre by centre: upper triangle of the matrix, row by row; then the sides
};

}  // namespace kacanov
