// SPDX-License-Identifier: BSD-3-Clause
// Double-double arithmetic with running rounding-error bounds (theory: gap-rounding).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <kacanov/obstacle.hpp>

namespace kacanov {

/// The unevaluated sum of two doubles, with a bound on its distance from the result of exact arithmetic on
/// the same input.
class Tracked {
 public:
  constexpr Tracked() = default;
  constexpr Tracked(double value) : high_(value) {}  // NOLINT: a double is exact
  /// The result of a standard library function, with its absolute error bound.
  static Tracked known_to(long double value, long double error) {
    const auto high = static_cast<double>(value);
    Tracked out(high, static_cast<double>(value - static_cast<long double>(high)));
    out.error_ = static_cast<double>(error) + unit * std::abs(high);
    return out;
  }

  double value() const noexcept { return high_ + low_; }
  double error() const noexcept { return error_; }

  friend Tracked operator-(const Tracked& a) {
    Tracked out = a;
    out.high_ = -a.high_;
    out.low_ = -a.low_;
    return out;
  }
  friend Tracked operator+(const Tracked& a, const Tracked& b) {
    const Tracked s = two_sum(a.high_, b.high_), t = two_sum(a.low_, b.low_);
    const Tracked u = quick_sum(s.high_, s.low_ + t.high_);
    return rounded(quick_sum(u.high_, u.low_ + t.low_), a.error_ + b.error_);
  }
  friend Tracked operator-(const Tracked& a, const Tracked& b) { return a + -b; }
  friend Tracked operator*(const Tracked& a, const Tracked& b) {
    const double p = a.high_ * b.high_, e = std::fma(a.high_, b.high_, -p);
    return rounded(quick_sum(p, e + (a.high_ * b.low_ + a.low_ * b.high_)),
                   std::abs(a.high_) * b.error_ + (std::abs(b.high_) + b.error_) * a.error_);
  }
  friend Tracked operator/(const Tracked& a, const Tracked& b) {
    const double first = a.high_ / b.high_;
    Tracked left = a - first * b;
    const double second = left.high_ / b.high_;
    left = left - second * b;
    const Tracked q = quick_sum(first, second) + Tracked(left.high_ / b.high_);
    const double least = std::abs(b.high_) - b.error_;
    return rounded(q, least > 0.0 ? (a.error_ + std::abs(q.high_) * b.error_) / least : HUGE_VAL);
  }
  /// Square root; 0 for values that rounding has made negative.
  friend Tracked sqrt(const Tracked& a) {
    if (!(a.high_ > 0.0)) return rounded({}, std::sqrt(a.error_ + std::max(-a.high_, 0.0)));
    const double near = std::sqrt(a.high_);
    const Tracked left = a - Tracked(near) * Tracked(near);
    return rounded(quick_sum(near, left.high_ / (2.0 * near)),
                   std::min(a.error_ / near, std::sqrt(a.error_)));
  }

 private:
  /// Upper bound on the rounding error of each operation, which is 3 to 15 units of 2⁻¹⁰⁶ of its result.
  static constexpr double unit = 0x1p-102;

  constexpr Tracked(double high, double low) : high_(high), low_(low) {}
  static Tracked two_sum(double a, double b) {
    const double s = a + b, part = s - a;
    return {s, (a - (s - part)) + (b - part)};
  }
  static Tracked quick_sum(double large, double small) {
    const double s = large + small;
    return {s, small - (s - large)};
  }
  static Tracked rounded(Tracked value, double error) {
    value.error_ = error + unit * std::abs(value.high_);
    return value;
  }

  double high_ = 0.0, low_ = 0.0, error_ = 0.0;
};

using TrackedVector = std::array<Tracked, 3>;

inline TrackedVector tracked(const Vector3& v) { return {v[0], v[1], v[2]}; }
inline Vector3 values(const TrackedVector& v) { return {v[0].value(), v[1].value(), v[2].value()}; }
inline TrackedVector operator-(const TrackedVector& a, const TrackedVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline TrackedVector operator+(const TrackedVector& a, const TrackedVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline TrackedVector operator*(const Tracked& s, const TrackedVector& v) {
  return {s * v[0], s * v[1], s * v[2]};
}
inline Tracked dot(const TrackedVector& a, const TrackedVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Tracked norm(const TrackedVector& v) { return sqrt(dot(v, v)); }
inline TrackedVector unit(const TrackedVector& v) { return Tracked(1.0) / norm(v) * v; }
inline TrackedVector unit(const Vector3& v) { return unit(tracked(v)); }

/// `lengths`: sum of the input lengths whose difference is the gap.
inline Facing facing(const TrackedVector& normal, const Tracked& gap, double lengths) {
  return {values(normal), gap.value(), gap.error(), lengths};
}

}  // namespace kacanov
