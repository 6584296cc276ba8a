// SPDX-License-Identifier: BSD-3-Clause
// Reads obstacles from files: height maps, and triangles of STL and Gmsh.
#include "verify/height_map.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "verify/file.hpp"
#include "verify/png.hpp"

namespace kacanov::verify {
namespace {

/// Rows of numbers, top row first.
using Rows = std::vector<std::vector<Real>>;

Rows comma_separated(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    for (char& c : line)
      if (c == ',' || c == ';') c = ' ';
    std::istringstream words(line);
    std::vector<Real> row;
    for (std::string word; words >> word;) row.push_back(std::stod(word));
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

Rows picture(const std::string& text) {
  const char kind = text[1];
  std::size_t at = 2;
  const auto skip = [&] {
    while (at < text.size() && (std::isspace(static_cast<unsigned char>(text[at])) || text[at] == '#'))
      at = text[at] == '#' ? std::min(text.find('\n', at), text.size()) : at + 1;
  };
  const auto integer = [&] {
    skip();
    std::size_t value = 0;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') value = 10 * value + (text[at++] - '0');
    return value;
  };
  const std::size_t width = integer(), height = integer(), most = kind == '2' || kind == '5' ? integer() : 1;
  if (kind == '4' || kind == '5') ++at;
  const auto byte = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(text.at(at++))); };
  Rows rows(height, std::vector<Real>(width));
  for (auto& row : rows) {
    std::size_t bits = 0;
    for (std::size_t i = 0; i < width; ++i) {
      std::size_t value = 0;
      if (kind == '1') {
        skip();
        value = text.at(at++) - '0';
      } else if (kind == '2') {
        value = integer();
      } else if (kind == '4') {
        if (i % 8 == 0) bits = byte();
        value = bits >> (7 - i % 8) & 1;
      } else {
        value = byte();
        if (most > 255) value = 256 * value + byte();
      }
      row[i] = Real(value) / Real(most);
    }
  }
  return rows;
}

}  // namespace

bool starts_with_dollar(const std::filesystem::path& file) { return whole(file).starts_with("$"); }

Face read_height_map(const nlohmann::json& given, const std::filesystem::path& folder) {
  const std::string text = whole(folder / given.at("file").get<std::string>());
  const bool image = text.size() > 2 && text[0] == 'P' && std::strchr("1245", text[1]) != nullptr;
  const Rows rows = image                         ? picture(text)
                    : text.starts_with("\x89PNG") ? png_rows(text)
                                                  : comma_separated(with_line_feeds(text));
  const Real scale = given.value("scale", 1.0), offset = given.value("offset", 0.0);
  const bool above = given.value("body", "above") == "above";
  std::array<Real, 2> lower{}, upper{};
  for (std::size_t c = 0; c < 2; ++c) {
    lower[c] = given.at("lower").at(c).get<double>();
    upper[c] = given.at("upper").at(c).get<double>();
  }
  const std::array<std::size_t, 2> points{rows.at(0).size(), rows.size()};
  return [=](const Vec& x, const Vec&) {
    Facing facing{{0, 0, above ? Real(-1) : Real(1)}, 0};
    std::array<std::size_t, 2> cell{};
    std::array<Real, 2> share{};
    for (std::size_t c = 0; c < 2; ++c) {
      const Real run = (x[c] - lower[c]) / (upper[c] - lower[c]), beyond = std::max(-run, run - 1);
      if (beyond > 1e-9L) facing.missed = true;
      if (std::abs(beyond - 1e-9L) < 1e-12L) facing.grazing = true;
      const Real index = std::min(std::max(run, Real(0)), Real(1)) * Real(points[c] - 1);
      cell[c] = std::min(static_cast<std::size_t>(index), points[c] - 2);
      share[c] = index - Real(cell[c]);
    }
    Real value = 0;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        value += (i == 1 ? share[0] : 1 - share[0]) * (j == 1 ? share[1] : 1 - share[1]) *
                 rows[points[1] - 1 - (cell[1] + j)][cell[0] + i];
    const Real open = x[2] - (offset + scale * value);
    facing.gap = above ? open : -open;
    return facing;
  };
}

std::vector<Triangle> read_stl(const std::filesystem::path& file) {
  const std::string text = whole(file);
  std::uint32_t count = 0;
  if (text.size() >= 84) std::memcpy(&count, &text[80], 4);
  std::vector<Triangle> triangles;
  if (text.size() >= 84 && text.size() == 84 + 50 * std::size_t{count}) {
    for (std::size_t t = 0; t < count; ++t)
      for (std::size_t k = 0; k < 9; ++k) {
        float value = 0;
        std::memcpy(&value, &text[84 + 50 * t + 12 + 4 * k], 4);
        if (k == 0) triangles.emplace_back();
        triangles.back()[k / 3][k % 3] = value;
      }
    return triangles;
  }
  std::istringstream words(with_line_feeds(text));
  std::size_t corners = 0;
  for (std::string word; words >> word;) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    if (word == "solid") std::getline(words, word);
    if (word != "vertex") continue;
    if (corners++ % 3 == 0) triangles.emplace_back();
    for (Real& c : triangles.back()[(corners - 1) % 3]) {
      words >> word;
      c = std::stod(word);
    }
  }
  return triangles;
}

}  // namespace kacanov::verify
