// SPDX-License-Identifier: BSD-3-Clause
// Valid ranges of the model's numbers, in words and as bounds: shared by validate(), the file readers and the
// case schema.
#pragma once

#include <limits>

namespace kacanov {

/// A range of numbers; infinite bounds impose nothing.
struct NumberRule {
  static constexpr double none = std::numeric_limits<double>::infinity();
  const char* words;  ///< as in "solver.tolerance: expected a number above 0 and below 1, got 2"
  double above = -none, least = -none;  ///< requires > above and ≥ least
  double below = none, most = none;     ///< requires < below and ≤ most

  constexpr bool holds(double v) const noexcept { return v > above && v >= least && v < below && v <= most; }
};

/// Squares of larger numbers may overflow.
inline constexpr double largest_number = 1e100;

inline constexpr NumberRule any_number{.words = "a number"};
inline constexpr NumberRule positive{.words = "a number > 0", .above = 0.0};
inline constexpr NumberRule not_negative{.words = "a number ≥ 0", .least = 0.0};
inline constexpr NumberRule above_one{.words = "a number > 1", .above = 1.0};
inline constexpr NumberRule up_to_one{.words = "a number > 0 and ≤ 1", .above = 0.0, .most = 1.0};
inline constexpr NumberRule below_one{.words = "a number above 0 and below 1", .above = 0.0, .below = 1.0};
inline constexpr NumberRule poisson_ratio{
    .words = "a number above -1 and below 0.5", .above = -1.0, .below = 0.5};
inline constexpr NumberRule cone_angle{
    .words = "an angle in degrees above 0 and below 90", .above = 0.0, .below = 90.0};
inline constexpr NumberRule time_after_start{.words = "a time after 0", .above = 0.0};
/// With smaller factors, squared forces underflow in the preconditioner's single precision.
inline constexpr double smallest_factor = 1e-15;
inline constexpr NumberRule load_factor{.words = "a factor ≥ 1e-15", .least = smallest_factor};
inline constexpr NumberRule over_relaxation{.words = "a number ≥ 1 and below 2", .least = 1.0, .below = 2.0};
inline constexpr NumberRule penalty_number{.words = "\"auto\", \"paper\" or a number > 0", .above = 0.0};

/// Rule for a list of load steps.
inline constexpr const char* last_factor = "factors on the load of which the last is 1";

}  // namespace kacanov
