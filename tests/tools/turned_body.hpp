// SPDX-License-Identifier: BSD-3-Clause
// Boxes that are rotated or deformed before they are written, and helpers that rotate their data.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "mesh_writer.hpp"
#include "program_runner.hpp"

namespace kacanov::testing {

using Point = std::array<double, 3>;

/// Rotates by 0.5 about (1, 2, 2)/3.
inline Point turned(const Point& x) {
  const Point a{1.0 / 3, 2.0 / 3, 2.0 / 3};
  const double c = std::cos(0.5), s = std::sin(0.5), along = a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
  const Point across{a[1] * x[2] - a[2] * x[1], a[2] * x[0] - a[0] * x[2], a[0] * x[1] - a[1] * x[0]};
  Point y{};
  for (std::size_t k = 0; k < 3; ++k) y[k] = c * x[k] + s * across[k] + (1 - c) * along * a[k];
  return y;
}

/// Rotates by 0.5 in the plane.
inline Point turned_in_plane(const Point& x) {
  return {std::cos(0.5) * x[0] - std::sin(0.5) * x[1], std::sin(0.5) * x[0] + std::cos(0.5) * x[1], x[2]};
}

/// Writes body.msh, a box with mapped nodes.
inline void put_mesh(const Workplace& place, const BoxSpec& box,
                     const std::function<Point(const Point&)>& map) {
  Mesh mesh = make_box(box);
  const std::size_t dim = mesh.dim();
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += dim) {
    Point at{};
    std::copy_n(&mesh.coordinates[i], dim, at.begin());
    const Point x = map(at);
    std::copy_n(x.begin(), dim, &mesh.coordinates[i]);
  }
  place.put("body.msh", gmsh_file(mesh, {.new_format = false}));
}

inline nlohmann::json list(const Point& x) { return {x[0], x[1], x[2]}; }
inline Point point_of(const nlohmann::json& list) {
  return {list.at(0), list.at(1), list.size() > 2 ? list.at(2).get<double>() : 0.0};
}
inline double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace kacanov::testing
