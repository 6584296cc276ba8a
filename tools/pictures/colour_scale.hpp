// SPDX-License-Identifier: BSD-3-Clause
// Values to bands of colour, perceptually uniform.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace kacanov {

using Rgb = std::array<std::uint8_t, 3>;
std::string hex(const Rgb& colour);

/// Bands of equal, round width. Where a few values stand out far above all others (a stress at a corner), the
/// last band is open and takes them all.
class ColourScale {
 public:
  explicit ColourScale(std::span<const double> values);

  int bands() const noexcept { return bands_; }
  bool open() const noexcept { return open_; }
  /// Lower end of a band; edge(bands()) is the upper end of the last.
  double edge(int band) const noexcept { return low_ + step_ * band; }
  int band(double value) const noexcept;
  /// `light` from 0 to 1: how much of the colour is lit.
  Rgb colour(int band, double light) const;

 private:
  double low_ = 0.0, step_ = 1.0;
  int bands_ = 1;
  bool open_ = false;
};

}  // namespace kacanov
