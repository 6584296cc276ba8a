// SPDX-License-Identifier: BSD-3-Clause
// Picture of a sweep: two panels over one logarithmic axis of r.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <kacanov/error.hpp>
#include "formats/xml.hpp"
#include "pictures/picture.hpp"
#include "pictures/svg.hpp"

namespace kacanov {
namespace {

constexpr double width = 760, left = 84, right = 24, top = 92, panel_height = 230, between = 34, bottom = 56;
constexpr const char* grid_colour = "#e3e3e3";
constexpr const char* failed_colour = "#c0392b";

struct Tick {
  double value;
  std::string label;  ///< empty: minor tick
};

/// A logarithmic axis from pixel `begin` to pixel `end`.
class LogAxis {
 public:
  LogAxis(double low, double high, double begin, double end) : begin_(begin), end_(end) {
    // At least half a decade, so that a single value has an axis too; plus a margin around the data.
    const double a = std::log10(low), b = std::log10(high);
    const double room = std::max(0.07 * (b - a), 0.25 - 0.5 * std::min(b - a, 0.5));
    low_ = a - room;
    high_ = b + room;
  }

  double pixel(double value) const {
    return begin_ + (std::log10(value) - low_) / (high_ - low_) * (end_ - begin_);
  }

  /// Ticks at powers of ten; if there are few, their multiples are labelled too.
  std::vector<Tick> ticks() const {
    const double decades = high_ - low_;
    const int first = static_cast<int>(std::floor(low_)), last = static_cast<int>(std::ceil(high_));
    const int skip = std::max(1, static_cast<int>(std::ceil(decades / 8)));
    std::vector<Tick> result;
    for (int decade = first; decade <= last; ++decade)
      for (int m = 1; m <= 9; ++m) {
        const double value = m * std::pow(10.0, decade);
        const double place = std::log10(value);
        if (place < low_ || place > high_) continue;
        const bool labelled =
            m == 1 ? decade % skip == 0 : (decades < 1.7 && (m == 2 || m == 5)) || decades < 0.6;
        if (labelled)
          result.push_back({value, decades < 3 ? short_number(value) : power_of_ten(decade)});
        else if (decades < 6)
          result.push_back({value, ""});
      }
    return result;
  }

 private:
  double begin_, end_, low_ = 0, high_ = 1;
};

LogAxis axis_of(const std::vector<double>& values, double begin, double end) {
  // Zeros (a run without iterations, a clock too coarse) are drawn at the lower end.
  double low = 0, high = 0;
  for (const double v : values)
    if (v > 0 && std::isfinite(v)) {
      low = low == 0 ? v : std::min(low, v);
      high = std::max(high, v);
    }
  return low == 0 ? LogAxis(1, 1, begin, end) : LogAxis(low, high, begin, end);
}

bool drawable(double v) { return v > 0 && std::isfinite(v); }

void check(const SweepPicture& picture) {
  const std::size_t n = picture.r.size();
  if (n == 0 || picture.iterations.size() != n || picture.seconds.size() != n ||
      picture.converged.size() != n)
    throw InternalError("sweep picture: the vectors are empty or of different length");
  if (!std::all_of(picture.r.begin(), picture.r.end(), drawable))
    throw InternalError("sweep picture: expected r > 0");
}

struct Panel {
  double top;
  const std::vector<double>& values;
  const char* label;
  const char* colour;
};

class Drawing {
 public:
  explicit Drawing(const SweepPicture& picture)
      : picture_(picture),
        canvas_(width, top + 2 * panel_height + between + bottom),
        x_(axis_of(all_r(picture), left, width - right)),
        order_(picture.r.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return picture.r[a] < picture.r[b]; });
  }

  std::string draw() {
    canvas_.text(left, 30, picture_.title, "font-size=\"17\" font-weight=\"bold\"");
    legend();
    const Panel iterations{top, picture_.iterations, "contact iterations", "#2c5f8a"};
    const Panel seconds{top + panel_height + between, picture_.seconds, "time / s", "#3b7d4f"};
    panel(iterations);
    panel(seconds);
    x_labels(seconds.top + panel_height);
    marks();
    best(iterations);
    best(seconds);
    return canvas_.finish();
  }

 private:
  static std::vector<double> all_r(const SweepPicture& picture) {
    std::vector<double> r = picture.r;
    for (const auto& mark : picture.marks)
      if (drawable(mark.value)) r.push_back(mark.value);
    return r;
  }

  void panel(const Panel& p) {
    const double base = p.top + panel_height;
    const LogAxis y = axis_of(p.values, base, p.top);
    for (const Tick& t : x_.ticks())
      canvas_.line(x_.pixel(t.value), p.top, x_.pixel(t.value), base,
                   "stroke=\"" + std::string(t.label.empty() ? "#f2f2f2" : grid_colour) + "\"");
    for (const Tick& t : y.ticks()) {
      const double at = y.pixel(t.value);
      canvas_.line(left, at, width - right, at,
                   "stroke=\"" + std::string(t.label.empty() ? "#f5f5f5" : grid_colour) + "\"");
      if (!t.label.empty()) canvas_.text(left - 8, at + 4.5, t.label, "text-anchor=\"end\"");
    }
    canvas_.rectangle(left, p.top, width - left - right, panel_height, "fill=\"none\" stroke=\"#555\"");
    const double middle = p.top + panel_height / 2;
    canvas_.text(
        22, middle, p.label,
        "text-anchor=\"middle\" font-size=\"14\" transform=\"rotate(-90 22 " + svg_number(middle) + ")\"");
    std::string data;
    for (const std::size_t i : order_) {
      data += data.empty() ? "M" : "L";
      data += svg_number(x_.pixel(picture_.r[i])) + " " + svg_number(height(y, p.values[i], base));
    }
    canvas_.path(data, "fill=\"none\" stroke=\"" + std::string(p.colour) + "\" stroke-width=\"1.8\"");
    for (const std::size_t i : order_)
      point(x_.pixel(picture_.r[i]), height(y, p.values[i], base), i, p.colour);
  }

  static double height(const LogAxis& y, double value, double base) {
    return value > 0 && std::isfinite(value) ? y.pixel(value) : base;
  }

  void point(double x, double y, std::size_t run, const char* colour) {
    if (picture_.converged[run])
      canvas_.circle(x, y, 3, "fill=\"" + std::string(colour) + "\"");
    else
      cross(x, y);
  }

  void cross(double x, double y) {
    canvas_.circle(x, y, 4.5, "fill=\"#fff\"");
    const std::string stroke = "stroke=\"" + std::string(failed_colour) + "\" stroke-width=\"1.8\"";
    canvas_.line(x - 3.5, y - 3.5, x + 3.5, y + 3.5, stroke);
    canvas_.line(x - 3.5, y + 3.5, x + 3.5, y - 3.5, stroke);
  }

  void x_labels(double base) {
    for (const Tick& t : x_.ticks())
      if (!t.label.empty()) canvas_.text(x_.pixel(t.value), base + 19, t.label, "text-anchor=\"middle\"");
    canvas_.markup((left + width - right) / 2, base + 42, "penalty <tspan font-style=\"italic\">r</tspan>",
                   "text-anchor=\"middle\" font-size=\"14\"");
  }

  /// Draws vertical lines through both panels; the labels above use as many rows as needed.
  void marks() {
    const double base = top + 2 * panel_height + between;
    std::vector<SweepPicture::Mark> sorted;
    std::copy_if(picture_.marks.begin(), picture_.marks.end(), std::back_inserter(sorted),
                 [](const auto& mark) { return drawable(mark.value); });
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
    double row_end = -1e9;
    int row = 0;
    for (const auto& mark : sorted) {
      const double x = x_.pixel(mark.value);
      const std::string value = " = " + short_number(mark.value);
      const double half = 4.0 * static_cast<double>(mark.name.size() + value.size());
      const double centre = std::clamp(x, left + half, width - right - half);
      row = centre - half < row_end ? (row + 1) % 2 : 0;
      row_end = centre + half;
      const double y = top - 8 - 16 * row;
      canvas_.line(x, y + 4, x, base, "stroke=\"#8e44ad\" stroke-width=\"1.4\" stroke-dasharray=\"6 4\"");
      canvas_.markup(centre, y, symbol(mark.name) + xml_escape(value),
                     "text-anchor=\"middle\" fill=\"#8e44ad\"");
    }
  }

  static std::string symbol(const std::string& name) {
    const std::size_t bar = name.find('_');
    const std::string main = "<tspan font-style=\"italic\">" + xml_escape(name.substr(0, bar)) + "</tspan>";
    if (bar == std::string::npos) return main;
    return main + "<tspan dy=\"3\" font-size=\"9.5\">" + xml_escape(name.substr(bar + 1)) +
           "</tspan><tspan dy=\"-3\">&#8203;</tspan>";
  }

  /// Draws a ring around the converged run with the smallest value.
  void best(const Panel& p) {
    std::size_t found = picture_.r.size();
    for (const std::size_t i : order_)
      if (picture_.converged[i] && (found == picture_.r.size() || p.values[i] < p.values[found])) found = i;
    if (found == picture_.r.size()) return;
    const double base = p.top + panel_height;
    const double x = x_.pixel(picture_.r[found]);
    const double y = height(axis_of(p.values, base, p.top), p.values[found], base);
    canvas_.circle(x, y, 7, "fill=\"none\" stroke=\"#d35400\" stroke-width=\"2\"");
    const std::string label = short_number(p.values[found]) + " at r = " + short_number(picture_.r[found]);
    const bool to_left = x > width / 2;
    // Label beside the ring, or above it if the ring is on the lower edge.
    canvas_.text(
        to_left ? x - 12 : x + 12, std::min(y + 16, base - 6), label,
        std::string(
            "fill=\"#d35400\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\" text-anchor=\"") +
            (to_left ? "end\"" : "start\""));
  }

  void legend() {
    double x = left;
    const double y = 52;
    canvas_.circle(x + 5, y - 4.5, 7, "fill=\"none\" stroke=\"#d35400\" stroke-width=\"2\"");
    canvas_.text(x + 18, y, "best run", "");
    x += 100;
    if (std::find(picture_.converged.begin(), picture_.converged.end(), false) == picture_.converged.end())
      return;
    cross(x + 5, y - 4.5);
    canvas_.text(x + 18, y, "not converged", "");
  }

  const SweepPicture& picture_;
  SvgCanvas canvas_;
  LogAxis x_;
  std::vector<std::size_t> order_;
};

}  // namespace

std::string sweep_svg(const SweepPicture& picture) {
  check(picture);
  return Drawing(picture).draw();
}

}  // namespace kacanov
