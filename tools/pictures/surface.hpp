// SPDX-License-Identifier: BSD-3-Clause
// What of a deformed body can be seen: its faces and outlines, projected onto the picture.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Orthogonal projection: to the right, upwards, and towards the eye.
struct View {
  std::array<double, 3> right{1, 0, 0}, up{0, 1, 0}, eye{0, 0, 1};

  /// Flat in 2D; in 3D from above, so turned that the body's longer horizontal side lies across the picture,
  /// or with the eye in the direction `towards`, where that is not zero, and z upwards.
  static View of(const Mesh& mesh, const std::array<double, 3>& towards = {});
  std::array<double, 3> project(std::span<const double> position) const;
};

/// A triangle turned towards the eye.
struct Face {
  std::array<std::array<double, 3>, 3> corners{};  ///< right, up, depth (larger is nearer)
  std::array<double, 3> values{};
  std::uint8_t shade = 0;  ///< 0 (darkest) … shades − 1
  std::uint8_t edges = 0;  ///< bit k: the side from corner k to k + 1 is one of the element
};
constexpr int shades = 8;

struct Segment {
  std::array<double, 3> from{}, to{};
};

struct VisibleSurface {
  std::vector<Face> faces;        ///< visible ones of the deformed body
  std::vector<Segment> outline;   ///< sharp edges and silhouette of the deformed body
  std::vector<Segment> original;  ///< the same of the undeformed one
};

/// Nodes of the triangles that make the surface, corner by corner: the whole body in 2D, its boundary in 3D.
std::vector<std::array<std::int32_t, 3>> surface_triangles(const Mesh& mesh);

/// Positions are x + scale·u; `values` are at the nodes.
VisibleSurface visible_surface(const Mesh& mesh, const View& view, std::span<const double> displacement,
                               double scale, std::span<const double> values);

}  // namespace kacanov
