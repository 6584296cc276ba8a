// SPDX-License-Identifier: BSD-3-Clause
// Maps values to bands of a perceptually uniform colour map.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace kacanov {

using Rgb = std::array<std::uint8_t, 3>;
std::string hex(const Rgb& colour);

/// Bands of equal width, a round number. If a few values far exceed all others (a stress at a corner), the
/// last band is open-ended and contains them.
class ColourScale {
 public:
  explicit ColourScale(std::span<const double> values);

  int bands() const noexcept { return bands_; }
  bool open() const noexcept { return open_; }
  /// Lower end of a band; edge(bands()) is the upper end of the last.
  double edge(int band) const noexcept { return low_ + step_ * band; }
  int band(double value) const noexcept;
  /// `light`: brightness factor from 0 to 1.
  Rgb colour(int band, double light) const;

 private:
  double low_ = 0.0, step_ = 1.0;
  int bands_ = 1;
  bool open_ = false;
};

}  // namespace kacanov
