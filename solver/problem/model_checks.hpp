// SPDX-License-Identifier: BSD-3-Clause
// Checks of single model values, with errors that cite their path in the case file.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>
#include <kacanov/obstacle.hpp>
#include <kacanov/model.hpp>
#include "problem/vector3.hpp"

namespace kacanov {

/// Returns the shortest text that reads back as the same number.
inline std::string shown(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

template <class Range>
std::string shown_list(const Range& values) {
  std::string text;
  for (const double v : values) text += (text.empty() ? "" : ",") + shown(v);
  return "[" + text + "]";
}

inline std::string at(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

[[noreturn]] inline void refuse(const std::string& path, const std::string& expected,
                                const std::string& got) {
  throw InputError(path + ": expected " + expected + ", got " + got);
}

inline void check(const std::string& path, double value, const NumberRule& rule = any_number) {
  if (!(std::abs(value) <= largest_number))
    refuse(path, std::string(rule.words) + " of a magnitude below 1e100", shown(value));
  if (!rule.holds(value)) refuse(path, rule.words, shown(value));
}

inline void check(const std::string& path, const Vector3& v) {
  for (std::size_t c = 0; c < 3; ++c) check(at(path, c), v[c]);
}

inline void check_direction(const std::string& path, const Vector3& v) {
  check(path, v);
  if (v == Vector3{}) refuse(path, "a vector that is not zero", shown_list(v));
}

/// Checks that the axes are orthogonal; they may have any length.
inline void check_axes(const std::string& path, const std::array<Vector3, 3>& axes) {
  for (std::size_t a = 0; a < 3; ++a) {
    check_direction(at(path, a), axes[a]);
    for (std::size_t b = 0; b < a; ++b)
      if (std::abs(dot(axes[a], axes[b])) > 1e-9 * norm(axes[a]) * norm(axes[b]))
        refuse(at(path, a), "an axis orthogonal to those before", shown_list(axes[a]));
  }
}

}  // namespace kacanov
