// SPDX-License-Identifier: BSD-3-Clause
// Writes the text of an SVG file element by element.
#include "pictures/svg.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "formats/xml.hpp"

namespace kacanov {

void append_svg_number(std::string& text, double value) {
  std::array<char, 32> digits{};
  const long hundredths = std::lround(value * 100);
  const int length = std::snprintf(digits.data(), digits.size(), "%s%ld.%02ld", hundredths < 0 ? "-" : "",
                                   std::labs(hundredths) / 100, std::labs(hundredths) % 100);
  std::string_view number(digits.data(), length);
  while (number.back() == '0') number.remove_suffix(1);
  if (number.back() == '.') number.remove_suffix(1);
  text += number;
}

std::string svg_number(double value) {
  std::string text;
  append_svg_number(text, value);
  return text;
}

std::string power_of_ten(int exponent) {
  constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += raised[digit - '0'];
  return text;
}

std::string short_number(double value) {
  std::array<char, 32> digits{};
  const double size = std::abs(value);
  if (!std::isfinite(value)) return std::isnan(value) ? "?" : value > 0 ? "∞" : "−∞";
  if (value == 0 || (size >= 1e-3 && size < 99950)) {
    std::snprintf(digits.data(), digits.size(), size >= 999.5 ? "%.0f" : "%.3g", value);
    return digits.data();
  }
  std::snprintf(digits.data(), digits.size(), "%.2e", value);
  std::string mantissa(digits.data());
  const std::size_t e = mantissa.find('e');
  const int exponent = std::stoi(mantissa.substr(e + 1));
  mantissa.resize(e);
  while (mantissa.back() == '0') mantissa.pop_back();
  if (mantissa.back() == '.') mantissa.pop_back();
  return mantissa + "·" + power_of_ten(exponent);
}

double nice_below(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0})
    if (value >= step * decade * (1 - 1e-9)) return step * decade;
  return decade;
}

SvgCanvas::SvgCanvas(double width, double height) : width_(width), height_(height) {}

void SvgCanvas::line(double x1, double y1, double x2, double y2, std::string_view attributes) {
  body_ += "<line x1=\"" + svg_number(x1) + "\" y1=\"" + svg_number(y1) + "\" x2=\"" + svg_number(x2) +
           "\" y2=\"" + svg_number(y2) + "\" ";
  body_.append(attributes).append("/>\n");
}

void SvgCanvas::rectangle(double x, double y, double width, double height, std::string_view attributes) {
  body_ += "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" width=\"" + svg_number(width) +
           "\" height=\"" + svg_number(height) + "\" ";
  body_.append(attributes).append("/>\n");
}

void SvgCanvas::circle(double x, double y, double radius, std::string_view attributes) {
  body_ +=
      "<circle cx=\"" + svg_number(x) + "\" cy=\"" + svg_number(y) + "\" r=\"" + svg_number(radius) + "\" ";
  body_.append(attributes).append("/>\n");
}

void SvgCanvas::path(std::string_view data, std::string_view attributes) {
  body_.append("<path d=\"").append(data).append("\" ").append(attributes).append("/>\n");
}

void SvgCanvas::text(double x, double y, std::string_view text, std::string_view attributes) {
  markup(x, y, xml_escape(text), attributes);
}

void SvgCanvas::markup(double x, double y, std::string_view markup, std::string_view attributes) {
  body_ += "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" ";
  body_.append(attributes).append(">").append(markup).append("</text>\n");
}

std::string SvgCanvas::finish() const {
  const std::string width = svg_number(width_), height = svg_number(height_);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
         "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"" +
         width + "\" height=\"" + height + "\" viewBox=\"0 0 " + width + " " + height +
         "\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#222\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         body_ + "</svg>\n";
}

}  // namespace kacanov
