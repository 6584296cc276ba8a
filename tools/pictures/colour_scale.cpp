// SPDX-License-Identifier: BSD-3-Clause
// The viridis colour map, and band limits at round numbers.
#include "pictures/colour_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "pictures/svg.hpp"

namespace kacanov {
namespace {

/// Eleven samples of the colour map viridis (Smith, van der Walt, Firing; CC0).
constexpr std::array<Rgb, 11> viridis{{{0x44, 0x01, 0x54},
                                       {0x48, 0x24, 0x75},
                                       {0x41, 0x44, 0x87},
                                       {0x35, 0x5f, 0x8d},
                                       {0x2a, 0x78, 0x8e},
                                       {0x21, 0x91, 0x8c},
                                       {0x22, 0xa8, 0x84},
                                       {0x44, 0xbf, 0x70},
                                       {0x7a, 0xd1, 0x51},
                                       {0xbd, 0xdf, 0x26},
                                       {0xfd, 0xe7, 0x25}}};

}  // namespace

std::string hex(const Rgb& colour) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", static_cast<unsigned>(colour[0]),
                static_cast<unsigned>(colour[1]), static_cast<unsigned>(colour[2]));
  return text.data();
}

ColourScale::ColourScale(std::span<const double> values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double v) { return std::isfinite(v); });
  if (finite.empty()) return;
  std::sort(finite.begin(), finite.end());
  double low = finite.front(), high = finite.back();
  const double usual = finite[(finite.size() - 1) * 995 / 1000];
  if (usual - low > 1e-6 * high && high - low > 1.4 * (usual - low)) {
    high = usual;
    open_ = true;
  }
  // A uniform field gets one colour on a scale from zero; otherwise the scale would magnify its rounding
  // errors.
  if (high - low <= 1e-6 * std::abs(high)) low = 0;
  if (high <= low) high = low + 1;
  step_ = nice_below((high - low) / 7);
  low_ = std::floor(low / step_ + 1e-9) * step_;
  bands_ = std::max(1, static_cast<int>(std::ceil((high - low_) / step_ - 1e-9)));
}

int ColourScale::band(double value) const noexcept {
  const double place = std::floor((value - low_) / step_);
  return place >= 0 ? static_cast<int>(std::min(place, static_cast<double>(bands_ - 1))) : 0;
}

Rgb ColourScale::colour(int band, double light) const {
  const double place = bands_ > 1 ? 10.0 * band / (bands_ - 1) : 5.0;
  const auto below = static_cast<std::size_t>(std::clamp(place, 0.0, 9.0));
  const double part = place - static_cast<double>(below);
  Rgb result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double full = viridis[below][k] * (1 - part) + viridis[below + 1][k] * part;
    result[k] = static_cast<std::uint8_t>(std::lround(full * (0.6 + 0.4 * light)));
  }
  return result;
}

}  // namespace kacanov
