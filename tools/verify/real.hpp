// SPDX-License-Identifier: BSD-3-Clause
// Arithmetic of the verifier: long double throughout, and vectors of three.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace kacanov::verify {

using Real = long double;
using Vec = std::array<Real, 3>;  ///< in 2D the third entry is 0

/// An unusable file: the message names the file or the key.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(Real s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Real norm(const Vec& a) { return std::sqrt(dot(a, a)); }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Returns the larger of the two; infinity if one is NaN.
inline Real larger(Real a, Real b) { return std::isnan(a) || std::isnan(b) ? HUGE_VALL : a < b ? b : a; }

}  // namespace kacanov::verify
