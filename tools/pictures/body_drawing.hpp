// SPDX-License-Identifier: BSD-3-Clause
// Draws the visible surface in bands of colour: as SVG paths up to most_faces faces, as a raster image above.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "pictures/colour_scale.hpp"
#include "pictures/surface.hpp"

namespace kacanov {

/// Maps the projection plane to pixels.
struct Frame {
  double left = 0, top = 0, width = 0, height = 0;  ///< pixels
  double low_x = 0, high_y = 0;                     ///< coordinates of the upper left corner
  double scale = 1;                                 ///< pixels per unit of length

  std::array<double, 2> pixel(const std::array<double, 3>& at) const {
    return {left + (at[0] - low_x) * scale, top + (high_y - at[1]) * scale};
  }
};

/// A body with more faces is drawn as an image.
constexpr std::size_t most_faces = 10000;

/// Returns SVG content. `flat`: no face can hide another (2D).
std::string draw_as_paths(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame,
                          bool flat);
/// Returns SVG content: one image with two of its pixels per SVG pixel.
std::string draw_as_image(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame);

}  // namespace kacanov
