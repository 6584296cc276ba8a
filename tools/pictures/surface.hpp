// SPDX-License-Identifier: BSD-3-Clause
// Visible surface of a deformed body: projected faces and outlines.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Orthographic projection: axes to the right, upwards and towards the eye.
struct View {
  std::array<double, 3> right{1, 0, 0}, up{0, 1, 0}, eye{0, 0, 1};

  /// 2D: the x-y plane. 3D: from above, turned so that the longer horizontal side of the body lies across the
  /// picture; if `towards` is not zero, from that direction with z upwards.
  static View of(const Mesh& mesh, const std::array<double, 3>& towards = {});
  std::array<double, 3> project(std::span<const double> position) const;
};

/// A triangle that faces the eye.
struct Face {
  std::array<std::array<double, 3>, 3> corners{};  ///< right, up, depth (a larger depth is nearer)
  std::array<double, 3> values{};
  std::uint8_t shade = 0;  ///< 0 (darkest) … shades − 1
  std::uint8_t edges = 0;  ///< bit k: the side from corner k to k + 1 is an element edge
};
constexpr int shades = 8;

struct Segment {
  std::array<double, 3> from{}, to{};
};

struct VisibleSurface {
  std::vector<Face> faces;        ///< visible faces of the deformed body
  std::vector<Segment> outline;   ///< sharp edges and silhouette of the deformed body
  std::vector<Segment> original;  ///< the same for the undeformed body
};

/// Returns the node triples of the surface triangles: the whole body in 2D, its boundary in 3D.
std::vector<std::array<std::int32_t, 3>> surface_triangles(const Mesh& mesh);

/// Node positions are x + scale·u; `values` are nodal.
VisibleSurface visible_surface(const Mesh& mesh, const View& view, std::span<const double> displacement,
                               double scale, std::span<const double> values);

}  // namespace kacanov
