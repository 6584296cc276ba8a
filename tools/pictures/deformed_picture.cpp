// SPDX-License-Identifier: BSD-3-Clause
// Picture of a deformed body: layout, obstacles, colour bar, captions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include <kacanov/error.hpp>
#include "pictures/body_drawing.hpp"
#include "pictures/picture.hpp"
#include "pictures/svg.hpp"

namespace kacanov {
namespace {

using Vector = std::array<double, 3>;

constexpr double width = 960, margin = 36, bar_space = 120, top = 64, bottom = 64;
constexpr double least_height = 240, most_height = 640;

/// Replaces non-finite values by 0, so that a diverged run can be drawn too.
std::vector<double> finite_or_zero(std::span<const double> values) {
  std::vector<double> result(values.begin(), values.end());
  for (double& v : result)
    if (!std::isfinite(v)) v = 0;
  return result;
}

double largest_norm(std::span<const double> vectors, std::size_t dim) {
  double largest = 0;
  for (std::size_t i = 0; i < vectors.size(); i += dim) {
    double square = 0;
    for (std::size_t k = 0; k < dim; ++k) square += vectors[i + k] * vectors[i + k];
    largest = std::max(largest, square);
  }
  return std::sqrt(largest);
}

struct Box {
  Vector low{}, high{};

  void add(const Vector& at) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
  double diagonal() const {
    return std::sqrt(std::pow(high[0] - low[0], 2) + std::pow(high[1] - low[1], 2) +
                     std::pow(high[2] - low[2], 2));
  }
  static Box empty() {
    constexpr double far = std::numeric_limits<double>::infinity();
    return {{far, far, far}, {-far, -far, -far}};
  }
};

Box body_box(const Mesh& mesh) {
  const std::size_t dim = mesh.dim();
  Box box = Box::empty();
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    Vector at{};
    for (std::size_t k = 0; k < dim; ++k) at[k] = mesh.coordinates[i * dim + k];
    box.add(at);
  }
  return box;
}

/// Returns 1 if the displacement is visible at that scale, else a round factor that makes the largest
/// displacement about 5 % of the body size.
double fitting_scale(double largest, double size) {
  if (largest <= 0 || largest >= 0.015 * size) return 1;
  return nice_below(0.06 * size / largest);
}

/// Returns the part of an obstacle plane near the body: two points in 2D, four in 3D; none if the plane is
/// far away.
std::vector<Vector> obstacle_patch(const DeformedPicture::Plane& plane, const Box& box, int dim) {
  const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const double length = std::sqrt(dot(plane.normal, plane.normal));
  if (!(length > 0)) return {};
  const Vector n{plane.normal[0] / length, plane.normal[1] / length, plane.normal[2] / length};
  // Tangents: one in 2D; in 3D the ones closest to two of the axes.
  Vector s{-n[1], n[0], 0}, t{};
  if (dim == 3) {
    const std::size_t axis = std::abs(n[0]) < 0.7 ? 0 : 1;
    Vector a{};
    a[axis] = 1;
    const double along = dot(a, n);
    for (std::size_t k = 0; k < 3; ++k) s[k] = a[k] - along * n[k];
    const double size = std::sqrt(dot(s, s));
    for (double& c : s) c /= size;
    t = {n[1] * s[2] - n[2] * s[1], n[2] * s[0] - n[0] * s[2], n[0] * s[1] - n[1] * s[0]};
  }
  double s_low = 1e300, s_high = -1e300, t_low = 1e300, t_high = -1e300, nearest = 1e300;
  for (int corner = 0; corner < 8; ++corner) {
    Vector d{};
    for (std::size_t k = 0; k < 3; ++k)
      d[k] = ((corner >> k & 1) != 0 ? box.high[k] : box.low[k]) - plane.point[k];
    s_low = std::min(s_low, dot(d, s));
    s_high = std::max(s_high, dot(d, s));
    t_low = std::min(t_low, dot(d, t));
    t_high = std::max(t_high, dot(d, t));
    nearest = std::min(nearest, std::abs(dot(d, n)));
  }
  if (nearest > 0.3 * box.diagonal()) return {};
  const double room = 0.06 * box.diagonal();
  const auto at = [&](double a, double b) {
    Vector p = plane.point;
    for (std::size_t k = 0; k < 3; ++k) p[k] += a * s[k] + b * t[k];
    return p;
  };
  if (dim == 2) return {at(s_low - room, 0), at(s_high + room, 0)};
  return {at(s_low - room, t_low - room), at(s_high + room, t_low - room), at(s_high + room, t_high + room),
          at(s_low - room, t_high + room)};
}

class Drawing {
 public:
  explicit Drawing(const DeformedPicture& picture)
      : picture_(picture),
        mesh_(*picture.mesh),
        dim_(mesh_.dim()),
        displacement_(finite_or_zero(picture.displacement)),
        nodal_values_(finite_or_zero(picture.values)),
        box_(body_box(mesh_)),
        view_(View::of(mesh_, picture.view)),
        largest_(largest_norm(displacement_, dim_)),
        scale_(picture.scale > 0 ? picture.scale : fitting_scale(largest_, box_.diagonal())),
        surface_(visible_surface(mesh_, view_, displacement_, scale_, nodal_values_)),
        colours_(nodal_values_) {
    for (const auto& plane : picture.planes) patches_.push_back(obstacle_patch(plane, box_, dim_));
    fit();
  }

  std::string draw() const {
    SvgCanvas canvas(width, top + frame_.height + bottom);
    canvas.text(margin, 34, picture_.title, "font-size=\"17\" font-weight=\"bold\"");
    if (shows_axis_) axis_of_revolution(canvas);
    for (const auto& patch : patches_) obstacle(canvas, patch);
    obstacle_facets(canvas);
    original(canvas);
    canvas.raw(surface_.faces.size() <= most_faces ? draw_as_paths(surface_, colours_, frame_, dim_ == 2)
                                                   : draw_as_image(surface_, colours_, frame_));
    marks(canvas);
    colour_bar(canvas);
    axes(canvas);
    canvas.text(margin, top + frame_.height + 40, caption(), "fill=\"#444\"");
    return canvas.finish();
  }

 private:
  /// Fits all drawn parts into the frame.
  void fit() {
    Box seen = Box::empty();
    for (const Face& f : surface_.faces)
      for (const Vector& c : f.corners) seen.add(c);
    for (const Segment& s : surface_.original) {
      seen.add(s.from);
      seen.add(s.to);
    }
    for (const auto& patch : patches_)
      for (const Vector& at : patch) seen.add(project(at));
    for (const auto& facet : picture_.obstacles)
      for (std::size_t k = 0; k < corners_of_facet(); ++k) seen.add(project(facet.corners[k]));
    shows_axis_ = mesh_.plane == PlaneState::axisymmetric && seen.low[0] < seen.high[0] - seen.low[0];
    if (shows_axis_) seen.add({0, seen.low[1], 0});
    const double w = seen.high[0] - seen.low[0], h = seen.high[1] - seen.low[1];
    frame_.left = margin;
    frame_.top = top;
    frame_.width = width - 2 * margin - bar_space;
    frame_.height = std::clamp(frame_.width * h / w, least_height, most_height);
    frame_.scale = std::min(frame_.width / w, frame_.height / h);
    frame_.low_x = seen.low[0] - (frame_.width / frame_.scale - w) / 2;
    frame_.high_y = seen.high[1] + (frame_.height / frame_.scale - h) / 2;
  }

  Vector project(const Vector& at) const { return view_.project(std::span(at).first(dim_)); }

  void obstacle(SvgCanvas& canvas, const std::vector<Vector>& patch) const {
    std::vector<std::array<double, 2>> p;
    for (const Vector& at : patch) p.push_back(frame_.pixel(project(at)));
    if (p.size() == 4) {
      std::string data;
      for (const auto& at : p)
        data += (data.empty() ? "M" : "L") + svg_number(at[0]) + " " + svg_number(at[1]);
      canvas.path(data + "Z", "fill=\"#eceff1\" stroke=\"#b0b8bd\"");
    } else if (p.size() == 2) {
      hatched(canvas, p[0], p[1]);
    }
  }

  /// Draws the axis as a chain line over the whole height, unless it is farther from the body than the body
  /// is wide.
  void axis_of_revolution(SvgCanvas& canvas) const {
    const double x = frame_.pixel({0, 0, 0})[0];
    canvas.line(x, top - 12, x, top + frame_.height + 12,
                "stroke=\"#777\" stroke-width=\"1\" stroke-dasharray=\"16 4 3 4\"");
    canvas.text(x + 5, top + frame_.height + 16, "axis",
                "font-size=\"12\" font-style=\"italic\" fill=\"#555\"");
  }

  std::size_t corners_of_facet() const { return static_cast<std::size_t>(dim_); }

  /// Draws the facets of curved obstacles that face the body.
  void obstacle_facets(SvgCanvas& canvas) const {
    std::string data;
    for (const auto& facet : picture_.obstacles) {
      if (dim_ == 2) {
        auto a = frame_.pixel(project(facet.corners[0])), b = frame_.pixel(project(facet.corners[1]));
        // hatched() expects the body on the side (−y, x) of a → b = (x, y), in pixels.
        if ((b[1] - a[1]) * facet.normal[0] + (b[0] - a[0]) * facet.normal[1] < 0) std::swap(a, b);
        hatched(canvas, a, b);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = frame_.pixel(project(facet.corners[k]));
        data += (k == 0 ? "M" : "L") + svg_number(at[0]) + " " + svg_number(at[1]);
      }
      data += "Z";
    }
    if (!data.empty() && data.size() <= most_outline)
      canvas.path(data, "fill=\"#dfe5e8\" stroke=\"#b0b8bd\" stroke-width=\"0.4\"");
  }

  /// Marks the nodes of sides that face the eye; all nodes in 2D.
  std::vector<bool> seen_nodes() const {
    std::vector<bool> seen(mesh_.node_count(), dim_ == 2);
    if (dim_ == 2) return seen;
    for (const auto& t : surface_triangles(mesh_)) {
      const Vector a = drawn(t[0]), b = drawn(t[1]), c = drawn(t[2]);
      if ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0)
        for (const std::int32_t node : t) seen[static_cast<std::size_t>(node)] = true;
    }
    return seen;
  }

  /// Position of a node of the deformed body in the picture plane.
  Vector drawn(std::int32_t node) const {
    Vector at{};
    const std::size_t n = static_cast<std::size_t>(node), dim = static_cast<std::size_t>(dim_);
    for (std::size_t k = 0; k < dim; ++k)
      at[k] = mesh_.coordinates[n * dim + k] + scale_ * displacement_[n * dim + k];
    return project(at);
  }

  /// Draws triangles at supports and arrows at loads; at most one per square of a few pixels.
  void marks(SvgCanvas& canvas) const {
    if (picture_.marks.empty()) return;
    const std::vector<bool> seen = seen_nodes();
    std::set<std::tuple<int, long, long>> taken;
    std::array<std::string, 3> paths;
    constexpr double apart = 24;
    for (const auto& mark : picture_.marks) {
      if (!seen[static_cast<std::size_t>(mark.node)]) continue;
      const auto kind = static_cast<int>(mark.kind);
      const auto at = frame_.pixel(drawn(mark.node));
      if (!taken.insert({kind, std::lround(at[0] / apart), std::lround(at[1] / apart)}).second) continue;
      paths[static_cast<std::size_t>(kind)] +=
          mark.kind == DeformedPicture::Mark::Kind::load
              ? arrow(at, project(mark.direction))
              : "M" + svg_number(at[0]) + " " + svg_number(at[1]) + "l-4.5 8h9Z";
    }
    constexpr std::array<const char*, 3> colours{"#1a4de6", "#9933b3", "#d91a1a"};
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const std::string colour = colours[kind];
      if (!paths[kind].empty())
        canvas.path(paths[kind], "fill=\"" + colour + "\" fill-opacity=\"0.75\" stroke=\"" + colour + "\"");
    }
  }

  /// An arrow that ends at `at`; a square if the direction is normal to the picture or unknown.
  static std::string arrow(const std::array<double, 2>& at, const Vector& along) {
    const double length = std::hypot(along[0], along[1]), whole = std::hypot(length, along[2]);
    const auto point = [](double x, double y) { return svg_number(x) + " " + svg_number(y); };
    if (!(length > 0.2 * whole)) return "M" + point(at[0] - 3, at[1] - 3) + "h6v6h-6Z";
    const double x = along[0] / length, y = -along[1] / length;
    const double neck_x = at[0] - 7 * x, neck_y = at[1] - 7 * y;
    return "M" + point(at[0] - 22 * x, at[1] - 22 * y) + "L" + point(neck_x, neck_y) + "L" +
           point(neck_x - 3 * y, neck_y + 3 * x) + "L" + point(at[0], at[1]) + "L" +
           point(neck_x + 3 * y, neck_y - 3 * x) + "L" + point(neck_x, neck_y) + "Z";
  }

  /// Draws a line with short strokes on the side away from the body.
  static void hatched(SvgCanvas& canvas, const std::array<double, 2>& a, const std::array<double, 2>& b) {
    canvas.line(a[0], a[1], b[0], b[1], "stroke=\"#555\" stroke-width=\"1.2\"");
    const double x = b[0] - a[0], y = b[1] - a[1], length = std::hypot(x, y);
    // The normal (−y, x) of a → b = (x, y), in pixels, points to the body.
    const double nx = -y / length, ny = x / length, tx = x / length, ty = y / length;
    std::string data;
    for (double s = 9; s < length; s += 9) {
      const double px = a[0] + s * tx, py = a[1] + s * ty;
      data += "M" + svg_number(px) + " " + svg_number(py) + "L" + svg_number(px - 6 * tx - 7 * nx) + " " +
              svg_number(py - 6 * ty - 7 * ny);
    }
    canvas.path(data, "fill=\"none\" stroke=\"#888\" stroke-width=\"0.8\"");
  }

  void original(SvgCanvas& canvas) const {
    std::string data;
    for (const Segment& s : surface_.original) {
      const auto a = frame_.pixel(s.from), b = frame_.pixel(s.to);
      data +=
          "M" + svg_number(a[0]) + " " + svg_number(a[1]) + "L" + svg_number(b[0]) + " " + svg_number(b[1]);
      if (data.size() > most_outline) return;  // the outline of such a rough body is not worth drawing
    }
    canvas.path(data, "fill=\"none\" stroke=\"#9a9a9a\" stroke-width=\"0.9\"");
  }

  void colour_bar(SvgCanvas& canvas) const {
    const double x = width - margin - bar_space + 34, height = std::min(frame_.height - 40, 360.0), wide = 18;
    const double y = top + (frame_.height - height) / 2 + 14, step = height / colours_.bands();
    canvas.text(x, y - 30, picture_.quantity[0], "");
    canvas.text(x, y - 15, picture_.quantity[1], "");
    for (int b = 0; b < colours_.bands(); ++b) {
      const std::string colour = hex(colours_.colour(b, 1));
      canvas.rectangle(x, y + height - (b + 1) * step, wide, step,
                       "fill=\"" + colour + "\" stroke=\"" + colour + "\"");
    }
    canvas.rectangle(x, y, wide, height, "fill=\"none\" stroke=\"#333\"");
    if (colours_.open()) {
      const std::string tip = "M" + svg_number(x) + " " + svg_number(y) + "l9 -9l9 9Z";
      canvas.path(tip, "stroke=\"#333\" fill=\"" + hex(colours_.colour(colours_.bands() - 1, 1)) + "\"");
    }
    const double band = colours_.edge(1) - colours_.edge(0);
    const long every = colours_.bands() > 12 ? 2 : 1;
    for (int b = 0; b <= colours_.bands(); ++b) {
      if (std::lround(colours_.edge(b) / band) % every != 0) continue;
      const double at = y + height - b * step;
      canvas.line(x + wide, at, x + wide + 5, at, "stroke=\"#333\"");
      canvas.text(x + wide + 9, at + 4.5, short_number(rounded(colours_.edge(b))), "");
    }
  }

  /// Band limits are sums of steps: round-off next to zero must print as 0.
  double rounded(double edge) const {
    const double step = colours_.edge(1) - colours_.edge(0);
    return std::abs(edge) < 1e-9 * step ? 0 : edge;
  }

  void axes(SvgCanvas& canvas) const {
    const double x = width - margin - 34, y = top + frame_.height + 46, size = 26;
    constexpr std::array<const char*, 3> names{"x", "y", "z"};
    for (std::size_t k = 0; k < static_cast<std::size_t>(dim_); ++k) {
      const double dx = size * view_.right[k], dy = -size * view_.up[k];
      canvas.line(x, y, x + dx, y + dy, "stroke=\"#555\" stroke-width=\"1.3\"");
      canvas.text(x + 1.35 * dx, y + 1.35 * dy + 4, names[k],
                  "text-anchor=\"middle\" font-size=\"12\" font-style=\"italic\" fill=\"#555\"");
    }
  }

  std::string caption() const {
    std::string text = scale_ == 1 ? "Displacement to scale" : "Displacement × " + short_number(scale_);
    text += ", largest " + short_number(largest_) + "; largest von Mises stress of an element " +
            short_number(picture_.largest_von_mises) + "; grey: undeformed";
    constexpr std::array<const char*, 3> words{"; blue: held", "; violet: on springs", "; red: loads"};
    for (std::size_t kind = 0; kind < words.size(); ++kind)
      if (std::any_of(picture_.marks.begin(), picture_.marks.end(),
                      [kind](const auto& mark) { return static_cast<std::size_t>(mark.kind) == kind; }))
        text += words[kind];
    return text;
  }

  static constexpr std::size_t most_outline = 1 << 19;

  const DeformedPicture& picture_;
  const Mesh& mesh_;
  int dim_;
  std::vector<double> displacement_, nodal_values_;
  Box box_;
  View view_;
  double largest_, scale_;
  VisibleSurface surface_;
  ColourScale colours_;
  std::vector<std::vector<Vector>> patches_;
  Frame frame_;
  bool shows_axis_ = false;
};

}  // namespace

std::string deformed_svg(const DeformedPicture& picture) {
  if (!picture.mesh || picture.displacement.size() != picture.mesh->coordinates.size() ||
      picture.values.size() != picture.mesh->node_count() || picture.mesh->facet_count() == 0)
    throw InternalError("picture: the displacement or the values do not fit the mesh");
  return Drawing(picture).draw();
}

}  // namespace kacanov
