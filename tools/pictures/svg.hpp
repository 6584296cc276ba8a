// SPDX-License-Identifier: BSD-3-Clause
// A drawing surface for SVG: lines, paths, texts, and numbers as people write them.
#pragma once

#include <string>
#include <string_view>

namespace kacanov {

/// Coordinates are pixels from the upper left corner. Attributes are given as SVG text: `stroke="#333"`.
class SvgCanvas {
 public:
  SvgCanvas(double width, double height);

  /// `content` as it is: groups, style sheets.
  void raw(std::string_view content) { body_ += content; }
  void line(double x1, double y1, double x2, double y2, std::string_view attributes);
  void rectangle(double x, double y, double width, double height, std::string_view attributes);
  void circle(double x, double y, double radius, std::string_view attributes);
  void path(std::string_view data, std::string_view attributes);
  /// Escapes `text`.
  void text(double x, double y, std::string_view text, std::string_view attributes);
  /// `markup` may hold tspans; it has to be escaped.
  void markup(double x, double y, std::string_view markup, std::string_view attributes);
  std::string finish() const;

 private:
  double width_, height_;
  std::string body_;
};

/// A coordinate: two decimals at most, no trailing zeros.
std::string svg_number(double value);
void append_svg_number(std::string& text, double value);
/// Three significant digits; very large and small ones with a power of ten.
std::string short_number(double value);
/// 10 to the power of `exponent`, with the exponent raised.
std::string power_of_ten(int exponent);
/// The largest of 1, 2, 5 times a power of ten that is ≤ value, for value > 0.
double nice_below(double value);

}  // namespace kacanov
