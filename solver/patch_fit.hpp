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

/// Places in space and what is known there: `sets` of six values each.
struct Samples {
  static constexpr std::size_t values = 6, most_sets = 2;
  std::span<const Vector3> position;
  std::array<const double*, most_sets> set{};  ///< positions × 6
};

/// Sums over samples about the mean of their places: what linear polynomials are fitted with round any
/// centre.
struct LinearSums {
  double count = 0.0;
  Vector3 mean{};
  std::array<std::array<double, 3>, 3> square{};  ///< of places from the mean
  std::array<std::array<std::array<double, Samples::values>, 4>, Samples::most_sets> side{};

  LinearSums(const Samples& samples, std::size_t sets);
};

/// Least squares round many centres at once.
class PatchFits {
 public:
  static constexpr std::size_t values = Samples::values;
  PatchFits(std::size_t centres, const Monomials& monomials, std::size_t sets = 1);

  bool linear() const noexcept { return monomials_.count() == monomials_.linear(); }
  std::size_t sets() const noexcept { return sets_; }
  /// `at`: the place of centre i; `scale`: one over its patch's size.
  void add(std::size_t i, const Vector3& at, double scale, const Samples& samples);
  /// The same of linear().
  void add(std::size_t i, const Vector3& at, double scale, const LinearSums& sums);
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
  /// After solve(): monomials × 6, of the polynomial of a set.
  const double* coefficients(std::size_t centre, std::size_t set) const noexcept {
    return &sums_[centre * width_ + pairs_ + set * values * monomials_.count()];
  }
  /// `x`: from the centre, times the scale.
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
  void add_of(double* sum, const Vector3& at, double scale, const Samples& samples) const;
  template <std::size_t n>
  void add_of(double* sum, const Vector3& from, double scale, const LinearSums& of) const;
  template <std::size_t n>
  void solve_of();

  Monomials monomials_;
  std::size_t sets_, pairs_, width_;
  /// Centre by centre: upper triangle of the matrix, row by row; then the sides, set by set.
  std::vector<double> sums_;
};

}  // namespace kacanov
