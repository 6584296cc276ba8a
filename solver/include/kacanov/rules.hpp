// SPDX-License-Identifier: BSD-3-Clause
// What the numbers of a model have to be, in words and as a test: one place for validate() and for readers of
// files.
#pragma once

namespace kacanov {

struct NumberRule {
  const char* words;  ///< as in "solver.tolerance: expected a number above 0 and below 1, got 2"
  bool (*holds)(double);
};

/// Numbers beyond it would overflow when squared on the way.
inline constexpr double largest_number = 1e100;

inline constexpr NumberRule any_number{"a number", [](double) { return true; }};
inline constexpr NumberRule positive{"a number > 0", [](double v) { return v > 0.0; }};
inline constexpr NumberRule not_negative{"a number ≥ 0", [](double v) { return v >= 0.0; }};
inline constexpr NumberRule above_one{"a number > 1", [](double v) { return v > 1.0; }};
inline constexpr NumberRule below_one{"a number above 0 and below 1",
                                      [](double v) { return v > 0.0 && v < 1.0; }};
inline constexpr NumberRule poisson_ratio{"a number above -1 and below 0.5",
                                          [](double v) { return v > -1.0 && v < 0.5; }};
/// Below it the squares of forces and their digits leave single precision, which the preconditioner works in.
inline constexpr double smallest_factor = 1e-15;
inline constexpr NumberRule load_factor{"a factor ≥ 1e-15", [](double v) { return v >= smallest_factor; }};
inline constexpr NumberRule over_relaxation{"a number ≥ 1 and below 2",
                                            [](double v) { return v >= 1.0 && v < 2.0; }};
inline constexpr NumberRule penalty_number{"\"auto\", \"paper\" or a number > 0",
                                           [](double v) { return v > 0.0; }};

/// Of a list of load steps.
inline constexpr const char* last_factor = "factors on the load of which the last is 1";

}  // namespace kacanov
