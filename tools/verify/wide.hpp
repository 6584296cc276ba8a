// SPDX-License-Identifier: BSD-3-Clause
// Quadruple precision arithmetic for gaps, which are differences of possibly large lengths.
#pragma once

#include <limits>

#include "verify/real.hpp"

namespace kacanov::verify {

#ifdef __SIZEOF_FLOAT128__
using Wide = __float128;
constexpr Real some_wide_roundings = 1e-33L;
#else
using Wide = long double;  // quadruple precision too on 64-bit ARM
constexpr Real some_wide_roundings = 10 * std::numeric_limits<long double>::epsilon();
#endif
/// A distinct type, so that its operators do not clash with those of Vec where Wide is Real.
struct WideVec : std::array<Wide, 3> {};

inline WideVec wide(const Vec& v) { return {v[0], v[1], v[2]}; }
inline Vec narrow(const WideVec& v) {
  return {static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])};
}
inline WideVec operator-(const WideVec& a, const WideVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline WideVec scaled(Wide s, const WideVec& v) { return {s * v[0], s * v[1], s * v[2]}; }
inline Wide inner(const WideVec& a, const WideVec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
/// Square root by Newton iteration from the long double root; 0 for negative arguments.
inline Wide root(Wide square) {
  if (!(square > 0)) return 0;
  Wide near = std::sqrt(static_cast<Real>(square));
  for (int step = 0; step < 2; ++step) near = (near + square / near) / 2;
  return near;
}
inline Wide length(const WideVec& v) { return root(inner(v, v)); }
inline WideVec unit(const WideVec& v) { return scaled(1 / length(v), v); }

}  // namespace kacanov::verify
