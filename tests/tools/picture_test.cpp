// SPDX-License-Identifier: BSD-3-Clause
// The pictures: well-formed XML, preserved areas, positions of marks, images that can be decoded.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include "pictures/body_drawing.hpp"
#include "pictures/picture.hpp"
#include "pictures/png.hpp"
#include "pictures/svg.hpp"

using namespace kacanov;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
  return found;
}

/// Returns whether tags nest, attributes are quoted and the text between is escaped.
bool well_formed(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = text.find("?>") + 2; at < text.size();) {
    if (text[at] != '<') {
      if (text[at] == '>' || (text[at] == '&' && text.find(';', at) > at + 7)) return false;
      ++at;
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = text.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos || count(tag, "\"") % 2 != 0) return false;
    const std::string name = tag.substr(tag[0] == '/', tag.find_first_of(" /\n", 1) - (tag[0] == '/'));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    at = end + 1;
  }
  return open.empty();
}

bool finite(const std::string& svg) {
  return svg.find("nan") == std::string::npos && svg.find("inf") == std::string::npos;
}

/// Returns the area of the closed polygons in SVG paths, by the shoelace formula.
double polygon_area(const std::string& svg) {
  double area = 0;
  for (std::size_t at = 0; (at = svg.find('M', at)) != std::string::npos;) {
    const std::size_t end = svg.find_first_of("ZM\"", at + 1);
    std::vector<std::array<double, 2>> points;
    for (std::size_t p = at; p < end; p = svg.find_first_of("LZM\"", p + 1)) {
      std::size_t used = 0;
      const double x = std::stod(svg.substr(p + 1), &used);
      points.push_back({x, std::stod(svg.substr(p + 1 + used))});
    }
    double twice = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& a = points[i];
      const auto& b = points[(i + 1) % points.size()];
      twice += a[0] * b[1] - b[0] * a[1];
    }
    if (svg[end] == 'Z') area += std::abs(twice) / 2;
    at = end;
  }
  return area;
}

/// Decodes deflate data with the fixed Huffman code, the only one that the writer uses.
class Inflate {
 public:
  explicit Inflate(const std::string& data) : data_(data) {}
  std::string run() {
    CHECK(bits(3) == 3);
    std::string out;
    constexpr std::array<std::size_t, 29> lengths{3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                  15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                  67, 83, 99, 115, 131, 163, 195, 227, 258};
    constexpr std::array<std::size_t, 30> distances{
        1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
        193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    for (;;) {
      const std::size_t s = symbol();
      if (s == 256) return out;
      if (s < 256) {
        out += static_cast<char>(s);
        continue;
      }
      const std::size_t l = s - 257;
      const std::size_t length = lengths[l] + bits(l < 8 || l == 28 ? 0 : l / 4 - 1);
      const std::size_t d = code(5);
      const std::size_t distance = distances[d] + bits(d < 4 ? 0 : d / 2 - 1);
      REQUIRE(distance <= out.size());
      for (std::size_t k = 0; k < length; ++k) out += out[out.size() - distance];
    }
  }

 private:
  std::size_t bit() {
    REQUIRE(at_ / 8 < data_.size());
    const std::size_t value = static_cast<unsigned char>(data_[at_ / 8]) >> (at_ % 8) & 1U;
    ++at_;
    return value;
  }
  std::size_t bits(std::size_t n) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < n; ++k) value |= bit() << k;
    return value;
  }
  std::size_t code(std::size_t n) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < n; ++k) value = value << 1 | bit();
    return value;
  }
  std::size_t symbol() {
    std::size_t v = code(7);
    if (v < 0x18) return v + 256;
    v = v << 1 | bit();
    if (v < 0xc0) return v - 0x30;
    if (v < 0xc8) return v - 0xc0 + 280;
    return (v << 1 | bit()) - 0x190 + 144;
  }
  const std::string& data_;
  std::size_t at_ = 0;
};

std::size_t big_endian(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

struct Bent {
  Mesh mesh;
  std::vector<double> displacement, stress;  // at the nodes
  DeformedPicture picture() const {
    DeformedPicture picture;
    picture.title = "a <beam> & \"more\"";
    picture.mesh = &mesh;
    picture.displacement = displacement;
    picture.values = stress;
    picture.largest_von_mises = 7.0;
    return picture;
  }
};

/// A box bent downwards, with a stress that increases along it.
Bent bent_box(const BoxSpec& spec, double amount) {
  Bent bent{make_box(spec), {}, {}};
  const std::size_t dim = bent.mesh.dim();
  bent.displacement.assign(bent.mesh.coordinates.size(), 0.0);
  for (std::size_t i = 0; i < bent.mesh.node_count(); ++i)
    bent.displacement[dim * i + dim - 1] =
        -amount * std::pow(bent.mesh.coordinates[dim * i] / spec.size[0], 2);
  for (std::size_t i = 0; i < bent.mesh.node_count(); ++i)
    bent.stress.push_back(bent.mesh.coordinates[dim * i]);
  return bent;
}

}  // namespace

TEST_CASE("the picture of a deformed body is well formed for every element type") {
  for (const ElementType type : element_types()) {
    const Bent bent = bent_box({{4, 1, 1}, {8, 3, 3}, type}, 0.5);
    DeformedPicture picture = bent.picture();
    picture.planes.push_back(
        {{0, 0, 0}, {0, bent.mesh.dim() == 2 ? 2.0 : 0.0, bent.mesh.dim() == 3 ? 2.0 : 0.0}});
    const std::string svg = deformed_svg(picture);
    CHECK(well_formed(svg));
    CHECK(finite(svg));
    CHECK(svg.find("a &lt;beam&gt; &amp; &quot;more&quot;") != std::string::npos);
    CHECK(svg.find("Displacement to scale, largest 0.5; largest von Mises stress of an element 7;") !=
          std::string::npos);
  }
}

TEST_CASE("a small displacement is enlarged by a round factor, and said so") {
  const std::string svg = deformed_svg(bent_box({{4, 1, 0}, {8, 3, 0}, ElementType::tri3}, 1e-4).picture());
  CHECK(svg.find("Displacement × 2000,") != std::string::npos);
}

TEST_CASE("supports, loads and obstacles are drawn where they are seen, and told") {
  using Mark = DeformedPicture::Mark;
  const Bent plane = bent_box({{4, 1, 0}, {8, 2, 0}, ElementType::tri3}, 0.5);
  DeformedPicture picture = plane.picture();
  CHECK(deformed_svg(picture).find("blue: held") == std::string::npos);
  // Nodes 0 and 1 are half a unit apart, and a repeated node is drawn once.
  for (const std::int32_t node : {0, 1, 1}) picture.marks.push_back({Mark::Kind::support, node, {}});
  picture.marks.push_back({Mark::Kind::load, 8, {0, -1, 0}});
  picture.obstacles.push_back({{{{0, -1, 0}, {4, -1, 0}, {4, -1, 0}}}, {0, 1, 0}});
  std::string svg = deformed_svg(picture);
  CHECK(well_formed(svg));
  CHECK(count(svg, "l-4.5 8h9Z") == 2);
  CHECK(svg.find("blue: held; red: loads") != std::string::npos);
  CHECK(svg.find("springs") == std::string::npos);
  // The arrow points down: it starts above its tip.
  const std::size_t fill = svg.find("fill=\"#d91a1a\""), path = svg.rfind("d=\"M", fill);
  double x = 0, y = 0, to_x = 0, to_y = 0;
  REQUIRE(std::sscanf(svg.c_str() + path, "d=\"M%lf %lfL%lf %lf", &x, &y, &to_x, &to_y) == 4);
  CHECK(x == doctest::Approx(to_x));
  CHECK(y < to_y);

  const Bent block = bent_box({{4, 2, 1}, {4, 2, 1}, ElementType::hex8}, 0.0);
  picture = block.picture();
  for (std::int32_t node = 0; node < 15; ++node) picture.marks.push_back({Mark::Kind::support, node, {}});
  picture.view = {0, 0, 2};
  CHECK(count(deformed_svg(picture), "l-4.5 8h9Z") == 0);  // all on the hidden side
  picture.view = {0, 0, -2};
  CHECK(count(deformed_svg(picture), "l-4.5 8h9Z") == 15);
  picture.view = {1, -1, -1};
  CHECK(well_formed(deformed_svg(picture)));

  Bent disc = plane;  // shows the axis of revolution, unless it is far away
  disc.mesh.plane = PlaneState::axisymmetric;
  for (const std::size_t axes : {1, 1, 0}) {
    CHECK(count(deformed_svg(disc.picture()), "x1=\"36\" y1=\"52\" x2=\"36\"") == axes);
    for (std::size_t i = 0; i < disc.mesh.coordinates.size(); i += 2) disc.mesh.coordinates[i] += 3.0;
  }
}

TEST_CASE("fields that are zero, uniform or broken still have a picture") {
  Bent bent = bent_box({{4, 1, 1}, {4, 1, 1}, ElementType::tet4}, 0.0);
  bent.stress.assign(bent.stress.size(), 0.0);
  CHECK(well_formed(deformed_svg(bent.picture())));
  bent.stress.assign(bent.stress.size(), 3.0);
  CHECK(well_formed(deformed_svg(bent.picture())));
  bent.stress[0] = std::nan("");
  bent.displacement[5] = std::numeric_limits<double>::infinity();
  const std::string svg = deformed_svg(bent.picture());
  CHECK(well_formed(svg));
  CHECK(finite(svg));
  bent.stress.pop_back();
  CHECK_THROWS_AS(deformed_svg(bent.picture()), InternalError);
}

TEST_CASE("a large mesh becomes an image, and the file stays small") {
  const std::string few = deformed_svg(bent_box({{4, 1, 0}, {64, 16, 0}, ElementType::tri3}, 0.5).picture());
  CHECK(few.find("<image") == std::string::npos);
  const std::string many =
      deformed_svg(bent_box({{4, 1, 0}, {400, 100, 0}, ElementType::tri3}, 0.5).picture());
  CHECK(many.find("<image") != std::string::npos);
  CHECK(well_formed(many));
  CHECK(many.size() < 500000);
}

TEST_CASE("bands of colour cover the body exactly once") {
  const Bent bent = bent_box({{4, 1, 0}, {32, 8, 0}, ElementType::tri3}, 0.5);  // shearing preserves the area
  const View view = View::of(bent.mesh);
  const VisibleSurface surface = visible_surface(bent.mesh, view, bent.displacement, 1, bent.stress);
  const ColourScale colours(bent.stress);
  const Frame frame{10, 20, 400, 150, 0, 1, 100};
  CHECK(surface.faces.size() == bent.mesh.element_count());
  std::string paths = draw_as_paths(surface, colours, frame, true);
  paths.resize(paths.find("</g>"));  // element lines follow
  CHECK(polygon_area(paths) == doctest::Approx(4 * 100 * 100).epsilon(0.01));
}

TEST_CASE("of a convex body, the visible faces project onto its shadow once") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    const Bent bent = bent_box({{3, 2, 1}, {3, 2, 2}, type}, 0.0);
    const View view = View::of(bent.mesh);
    const VisibleSurface surface = visible_surface(bent.mesh, view, bent.displacement, 1, bent.stress);
    double area = 0;
    for (const Face& f : surface.faces) {
      const auto& c = f.corners;
      const double part =
          ((c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[1][1] - c[0][1]) * (c[2][0] - c[0][0])) / 2;
      CHECK(part > 0);
      area += part;
    }
    CHECK(area ==
          doctest::Approx(2 * std::abs(view.eye[0]) + 3 * std::abs(view.eye[1]) + 6 * std::abs(view.eye[2])));
    // The outline has the twelve edges of the box without three hidden ones.
    double length = 0, seen = 0;
    for (const Segment& s : surface.outline)
      length += std::hypot(s.to[0] - s.from[0], s.to[1] - s.from[1], s.to[2] - s.from[2]);
    for (const double side : {3.0, 2.0, 1.0}) seen += 3 * side;
    CHECK(length == doctest::Approx(seen));
  }
}

TEST_CASE("the colour scale covers the values in bands of equal, round width") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const double size = std::pow(10, static_cast<int>(random() % 12) - 6);
    std::vector<double> values;
    for (int i = 0; i < 300; ++i) values.push_back(size * (1 + 1e-3 * static_cast<double>(random() % 1000)));
    const ColourScale scale(values);
    CHECK(scale.bands() >= 2);
    CHECK(scale.bands() <= 24);
    for (const double v : values) {
      const int b = scale.band(v);
      CHECK(scale.edge(b) <= v * (1 + 1e-9));
      CHECK((v <= scale.edge(b + 1) * (1 + 1e-9) || scale.open()));
    }
    double before = -1;
    for (int b = 0; b < scale.bands(); ++b) {  // viridis is monotone in lightness
      const Rgb c = scale.colour(b, 1);
      const double light = 0.21 * c[0] + 0.72 * c[1] + 0.07 * c[2];
      CHECK(light > before);
      before = light;
    }
  }
  std::vector<double> peak(1000, 1.0);
  for (std::size_t i = 0; i < 500; ++i) peak[i] = 0.5;
  CHECK(!ColourScale(peak).open());
  peak[7] = 1000;
  CHECK(ColourScale(peak).open());
  CHECK(ColourScale(peak).edge(ColourScale(peak).bands()) < 2);
}

TEST_CASE("an image decodes to what was drawn") {
  std::mt19937 random(1);
  const std::vector<Rgb> palette{{255, 255, 255}, {1, 2, 3}, {4, 5, 6}, {200, 100, 50}};
  for (const std::size_t width : {1, 7, 300, 3000}) {
    std::vector<std::uint8_t> pixels(width * 40);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = static_cast<std::uint8_t>(i < 20 * width ? random() % 256 : (i / 97) % 4);
    const std::string png = encode_png(width, pixels, palette);
    CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    CHECK(big_endian(png, 16) == width);
    CHECK(big_endian(png, 20) == 40);
    const std::size_t data = png.find("IDAT");
    REQUIRE(data != std::string::npos);
    const std::string rows = Inflate(png.substr(data + 6, big_endian(png, data - 4) - 6)).run();
    REQUIRE(rows.size() == 40 * (width + 1));
    std::size_t wrong = 0;
    for (std::size_t y = 0; y < 40; ++y)
      for (std::size_t x = 0; x < width; ++x)
        wrong += static_cast<std::uint8_t>(rows[y * (width + 1) + 1 + x]) != pixels[y * width + x];
    CHECK(wrong == 0);
    CHECK(png.substr(png.size() - 8) == std::string("IEND\xae\x42\x60\x82"));
  }
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
}

TEST_CASE("numbers are short and exact enough") {
  CHECK(svg_number(1.25) == "1.25");
  CHECK(svg_number(-0.5) == "-0.5");
  CHECK(svg_number(3.0) == "3");
  CHECK(svg_number(-0.001) == "0");
  CHECK(short_number(0.31279) == "0.313");
  CHECK(short_number(479) == "479");
  CHECK(short_number(12345) == "12345");
  CHECK(short_number(1.5e-7) == "1.5·10⁻⁷");
  CHECK(short_number(-2e12) == "-2·10¹²");
  CHECK(power_of_ten(-10) == "10⁻¹⁰");
  CHECK(nice_below(0.07) == doctest::Approx(0.05));
  CHECK(nice_below(2) == doctest::Approx(2));
  CHECK(nice_below(1999) == doctest::Approx(1000));
}

TEST_CASE("a sweep shows every run, its marks in order, and the runs that failed") {
  SweepPicture picture{"sweep & <more>", {}, {}, {}, {}, {{"r_A", 5}, {"r*", 0.3}, {"none", 0}}};
  for (int i = 0; i < 20; ++i) {
    picture.r.push_back(std::pow(10, 3 - 0.25 * i));
    picture.iterations.push_back(50 + 20 * std::abs(i - 8));
    picture.seconds.push_back(0.01 * (1 + i));
    picture.converged.push_back(i < 15);
  }
  const std::string svg = sweep_svg(picture);
  CHECK(well_formed(svg));
  CHECK(finite(svg));
  CHECK(count(svg, "r=\"3\"") == 2 * 15);
  CHECK(count(svg, "r=\"4.5\"") == 2 * 5 + 1);  // plus one in the legend
  CHECK(svg.find("not converged") != std::string::npos);
  for (const char* label : {">10⁻¹<", ">10⁰<", ">10²<"}) CHECK(svg.find(label) != std::string::npos);
  CHECK(svg.find(">none<") == std::string::npos);
  // Positions of the marked lines, from left to right.
  std::vector<double> places;
  for (std::size_t at = 0; (at = svg.find("#8e44ad\" stroke-width", at)) != std::string::npos; ++at)
    places.push_back(std::stod(svg.substr(svg.rfind("x1=\"", at) + 4)));
  REQUIRE(places.size() == 2);
  CHECK(places[0] < places[1]);
}

TEST_CASE("a sweep of one run, of zeros and of equal values has axes") {
  CHECK(well_formed(sweep_svg({"one", {2}, {30}, {0.5}, {true}, {}})));
  const std::string zeros = sweep_svg({"zeros", {1, 10}, {0, 0}, {0, 0}, {false, true}, {}});
  CHECK(well_formed(zeros));
  CHECK(finite(zeros));
  CHECK_THROWS_AS(sweep_svg({"none", {}, {}, {}, {}, {}}), InternalError);
  CHECK_THROWS_AS(sweep_svg({"lengths", {1, 2}, {1}, {1, 2}, {true, true}, {}}), InternalError);
  CHECK_THROWS_AS(sweep_svg({"negative", {-1}, {1}, {1}, {true}, {}}), InternalError);
}
