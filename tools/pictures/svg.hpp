// SPDX-License-Identifier: BSD-3-Clause
// Writes SVG elements (lines, paths, texts) and formats numbers for labels.
#pragma once

#include <string>
#include <string_view>

namespace kacanov {

/// Coordinates are pixels from the upper left corner. Attributes are given as SVG text: `stroke="#333"`.
class SvgCanvas {
 public:
  SvgCanvas(double width, double height);

  /// Appends `content` unchanged: groups, style sheets.
  void raw(std::string_view content) { body_ += content; }
  void line(double x1, double y1, double x2, double y2, std::string_view attributes);
  void rectangle(double x, double y, double width, double height, std::string_view attributes);
  void circle(double x, double y, double radius, std::string_view attributes);
  void path(std::string_view data, std::string_view attributes);
  /// Escapes `text`.
  void text(double x, double y, std::string_view text, std::string_view attributes);
  /// `markup` may contain tspans; the caller escapes it.
  void markup(double x, double y, std::string_view markup, std::string_view attributes);
  std::string finish() const;

 private:
  double width_, height_;
  std::string body_;
};

/// Formats a coordinate with at most two decimals and no trailing zeros.
std::string svg_number(double value);
void append_svg_number(std::string& text, double value);
/// Three significant digits; very large and small numbers with a power of ten.
std::string short_number(double value);
/// 10 to the power of `exponent`, with the exponent as superscript.
std::string power_of_ten(int exponent);
/// Returns the largest number ≤ value of the form 1, 2 or 5 times a power of ten; value > 0.
double nice_below(double value);

}  // namespace kacanov
