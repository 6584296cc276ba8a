// SPDX-License-Identifier: BSD-3-Clause
// Draws a visible surface in bands of colour: as paths while they are few, as an image where they are many.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "pictures/colour_scale.hpp"
#include "pictures/surface.hpp"

namespace kacanov {

/// From the plane of projection to pixels.
struct Frame {
  double left = 0, top = 0, width = 0, height = 0;  ///< pixels
  double low_x = 0, high_y = 0;                     ///< what lies at the upper left corner
  double scale = 1;                                 ///< pixels a unit of length

  std::array<double, 2> pixel(const std::array<double, 3>& at) const {
    return {left + (at[0] - low_x) * scale, top + (high_y - at[1]) * scale};
  }
};

/// Above this number of faces the body is an image.
constexpr std::size_t most_faces = 10000;

/// SVG content. `flat`: nothing can hide anything (2D).
std::string draw_as_paths(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame,
                          bool flat);
/// SVG content: one image, two pixels of it to one of the picture.
std::string draw_as_image(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame);

}  // namespace kacanov
