// SPDX-License-Identifier: BSD-3-Clause
// Draws a surface as SVG paths with the painter's algorithm, back to front.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pictures/body_drawing.hpp"
#include "pictures/svg.hpp"

namespace kacanov {
namespace {

constexpr std::size_t most_edged_faces = 5000;  // 3D: above this, edges would double the file size
constexpr double brightest = shades - 1;

/// A polygon corner: position in pixels, and value.
struct Corner {
  double x, y, value;
};

/// Clips `polygon` to the values ≥ `limit` (≤ if not `above`) and appends the result to `part`.
void clip(const std::vector<Corner>& polygon, double limit, bool above, std::vector<Corner>& part) {
  part.clear();
  const auto inside = [&](const Corner& c) { return above ? c.value >= limit : c.value <= limit; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    if (inside(a)) part.push_back(a);
    if (inside(a) == inside(b)) continue;
    const double t = (limit - a.value) / (b.value - a.value);
    part.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), limit});
  }
}

/// Rounds to a tenth of a pixel; finer steps are invisible.
void append_point(std::string& path, char command, double x, double y) {
  path += command;
  append_svg_number(path, std::round(x * 10) / 10);
  path += ' ';
  append_svg_number(path, std::round(y * 10) / 10);
}

class Painter {
 public:
  Painter(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame)
      : surface_(surface), colours_(colours), frame_(frame) {}

  /// All polygons of a band form one path.
  std::string flat() {
    std::vector<std::string> bands(colours_.bands());
    std::string edges;
    for (const Face& face : surface_.faces) {
      polygons(face,
               [&](int band, const std::vector<Corner>& polygon) { append_polygon(bands[band], polygon); });
      append_edges(edges, face);
    }
    std::string text = "<g stroke-width=\"0.6\" stroke-linejoin=\"round\">\n";
    for (int b = 0; b < colours_.bands(); ++b) {
      if (bands[b].empty()) continue;
      const std::string colour = hex(colours_.colour(b, 1));
      text += "<path fill=\"" + colour + "\" stroke=\"" + colour + "\" d=\"" + bands[b] + "\"/>\n";
    }
    text += "</g>\n";
    text += "<path fill=\"none\" stroke=\"#000\" stroke-opacity=\"0.3\" stroke-width=\"0.35\" d=\"" + edges +
            "\"/>\n";
    std::string outline;
    for (const Segment& s : surface_.outline) append_segment(outline, s);
    return text + "<path fill=\"none\" stroke=\"#111\" stroke-width=\"1\" stroke-linecap=\"round\" d=\"" +
           outline + "\"/>\n";
  }

  /// Draws faces and outlines in order of depth.
  std::string layered() {
    std::string text = style();
    for (const std::size_t item : order()) {
      if (item >= surface_.faces.size()) {
        std::string path;
        append_segment(path, surface_.outline[item - surface_.faces.size()]);
        put(text, "o", path);
        continue;
      }
      const Face& face = surface_.faces[item];
      polygons(face, [&](int band, const std::vector<Corner>& polygon) {
        std::string path;
        append_polygon(path, polygon);
        put(text, "c" + std::to_string(band * shades + face.shade), path);
      });
      if (surface_.faces.size() <= most_edged_faces) {
        std::string path;
        append_edges(path, face);
        if (!path.empty()) put(text, "e", path);
      }
    }
    flush(text);
    return text + "</g>\n";
  }

 private:
  std::string style() const {
    std::string text = "<style>\n";
    for (int b = 0; b < colours_.bands(); ++b)
      for (int s = 0; s < shades; ++s) {
        const std::string colour = hex(colours_.colour(b, s / brightest));
        text += ".c" + std::to_string(b * shades + s) + "{fill:" + colour + ";stroke:" + colour + "}\n";
      }
    return text + ".e{fill:none;stroke:#000;stroke-opacity:.25;stroke-width:.4}\n" +
           ".o{fill:none;stroke:#111;stroke-width:1.1;stroke-linecap:round}\n</style>\n" +
           "<g stroke-width=\"0.5\" stroke-linejoin=\"round\">\n";
  }

  /// Returns the indices of faces, then of outlines, sorted farthest first. An outline follows the faces it
  /// bounds.
  std::vector<std::size_t> order() const {
    std::vector<double> depth;
    double size = 0;
    for (const Face& f : surface_.faces) {
      depth.push_back((f.corners[0][2] + f.corners[1][2] + f.corners[2][2]) / 3);
      size += std::hypot(f.corners[0][0] - f.corners[1][0], f.corners[0][1] - f.corners[1][1],
                         f.corners[0][2] - f.corners[1][2]);
    }
    size /= std::max<double>(1, static_cast<double>(surface_.faces.size()));
    for (const Segment& s : surface_.outline) depth.push_back((s.from[2] + s.to[2]) / 2 + size);
    std::vector<std::size_t> result(depth.size());
    std::iota(result.begin(), result.end(), std::size_t{0});
    std::stable_sort(result.begin(), result.end(),
                     [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
    return result;
  }

  /// Adjacent paths of the same class share an element.
  void put(std::string& text, const std::string& style_class, const std::string& path) {
    if (style_class != pending_class_) {
      flush(text);
      pending_class_ = style_class;
    }
    pending_ += path;
  }

  void flush(std::string& text) {
    if (!pending_.empty()) text += "<path class=\"" + pending_class_ + "\" d=\"" + pending_ + "\"/>\n";
    pending_.clear();
  }

  /// Calls visit(band, polygon) for every band that the face intersects.
  template <typename Visit>
  void polygons(const Face& face, Visit&& visit) {
    whole_.clear();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [x, y] = frame_.pixel(face.corners[k]);
      whole_.push_back({x, y, face.values[k]});
    }
    const auto [low, high] = std::minmax_element(face.values.begin(), face.values.end());
    const int first = colours_.band(*low), last = colours_.band(*high);
    for (int band = first; band <= last; ++band) {
      rest_ = whole_;
      if (band > first) {
        clip(rest_, colours_.edge(band), true, part_);
        std::swap(rest_, part_);
      }
      if (band < last) {
        clip(rest_, colours_.edge(band + 1), false, part_);
        std::swap(rest_, part_);
      }
      if (rest_.size() >= 3) visit(band, rest_);
    }
  }

  static void append_polygon(std::string& path, const std::vector<Corner>& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      append_point(path, i == 0 ? 'M' : 'L', polygon[i].x, polygon[i].y);
    path += 'Z';
  }

  void append_segment(std::string& path, const Segment& s) const {
    const auto a = frame_.pixel(s.from), b = frame_.pixel(s.to);
    append_point(path, 'M', a[0], a[1]);
    append_point(path, 'L', b[0], b[1]);
  }

  void append_edges(std::string& path, const Face& face) const {
    for (std::size_t k = 0; k < 3; ++k)
      if ((face.edges >> k & 1) != 0) append_segment(path, {face.corners[k], face.corners[(k + 1) % 3]});
  }

  const VisibleSurface& surface_;
  const ColourScale& colours_;
  const Frame& frame_;
  std::vector<Corner> whole_, rest_, part_;
  std::string pending_class_, pending_;
};

}  // namespace

std::string draw_as_paths(const VisibleSurface& surface, const ColourScale& colours, const Frame& frame,
                          bool flat) {
  Painter painter(surface, colours, frame);
  return flat ? painter.flat() : painter.layered();
}

}  // namespace kacanov
