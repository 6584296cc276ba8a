// SPDX-License-Identifier: BSD-3-Clause
// Rasterises a surface with a depth buffer.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pictures/body_drawing.hpp"
#include "pictures/png.hpp"
#include "pictures/svg.hpp"

namespace kacanov {
namespace {

constexpr double pixels = 2;  // image pixels per SVG pixel, in each direction

class Image {
 public:
  Image(const ColourScale& colours, const Frame& frame)
      : colours_(colours),
        frame_(frame),
        width_(static_cast<int>(std::ceil(frame.width * pixels))),
        height_(static_cast<int>(std::ceil(frame.height * pixels))),
        index_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0),
        depth_(index_.size(), -std::numeric_limits<double>::infinity()) {}

  void paint(const Face& face) {
    std::array<std::array<double, 2>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = place(face.corners[k]);
    const double area = cross(p[0], p[1], p[2]);
    if (area == 0) return;
    const auto [left, right] = std::minmax({p[0][0], p[1][0], p[2][0]});
    const auto [top, bottom] = std::minmax({p[0][1], p[1][1], p[2][1]});
    for (int y = first(top); y <= last(bottom, height_); ++y)
      for (int x = first(left); x <= last(right, width_); ++x) {
        const std::array<double, 2> at{x + 0.5, y + 0.5};
        const double a = cross(p[1], p[2], at) / area, b = cross(p[2], p[0], at) / area, c = 1 - a - b;
        constexpr double edge = -1e-9;  // no gap along a side that two triangles share
        if (a < edge || b < edge || c < edge) continue;
        const double depth = a * face.corners[0][2] + b * face.corners[1][2] + c * face.corners[2][2];
        const double value = a * face.values[0] + b * face.values[1] + c * face.values[2];
        put(x, y, depth, 2 + colours_.band(value) * shades + face.shade);
      }
  }

  /// Draws a dark line, slightly in front of the faces that it bounds.
  void paint(const Segment& s) {
    const auto a = place(s.from), b = place(s.to);
    const int steps = 1 + static_cast<int>(std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1])));
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const double depth = s.from[2] + t * (s.to[2] - s.from[2]) + 4 / (frame_.scale * pixels);
      const int x = static_cast<int>(std::floor(a[0] + t * (b[0] - a[0])));
      const int y = static_cast<int>(std::floor(a[1] + t * (b[1] - a[1])));
      put(x, y, depth, 1);
      put(x + 1, y, depth, 1);
      put(x, y + 1, depth, 1);
    }
  }

  std::string svg() const {
    std::vector<Rgb> palette{{255, 255, 255}, {20, 20, 20}};
    for (int b = 0; b < colours_.bands(); ++b)
      for (int s = 0; s < shades; ++s)
        palette.push_back(colours_.colour(b, static_cast<double>(s) / (shades - 1)));
    return "<image x=\"" + svg_number(frame_.left) + "\" y=\"" + svg_number(frame_.top) + "\" width=\"" +
           svg_number(width_ / pixels) + "\" height=\"" + svg_number(height_ / pixels) +
           "\" xlink:href=\"data:image/png;base64," + base64(encode_png(width_, index_, palette)) + "\"/>\n";
  }

 private:
  static double cross(const std::array<double, 2>& a, const std::array<double, 2>& b,
                      const std::array<double, 2>& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  std::array<double, 2> place(const std::array<double, 3>& at) const {
    const auto p = frame_.pixel(at);
    return {(p[0] - frame_.left) * pixels, (p[1] - frame_.top) * pixels};
  }
  static int first(double low) { return std::max(0, static_cast<int>(std::floor(low - 0.5))); }
  static int last(double high, int size) {
    return std::min(size - 1, static_cast<int>(std::ceil(high - 0.5)));
  }

  void put(int x, int y, double depth, int index) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    if (depth < depth_[at]) return;
    depth_[at] = depth;
    index_[at] = static_cast<std::uint8_t>(index);
  }

  const ColourScale& colours_;
  const Frame& frame_;
  int width_, height_;
  std::vector<std::uint8_t> index_;
  std::vector<double> depth_;
};

}  // namespace

std::string draw_as_image(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame) {
  Image image(colours, frame);
  for (const Face& face : surface.faces) image.paint(face);
  for (const Segment& segment : surface.outline) image.paint(segment);
  return image.svg();
}

}  // namespace kacanov
