// SPDX-License-Identifier: BSD-3-Clause
// Rigid obstacles: how each is seen from a point of the body's surface.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <kacanov/vector3.hpp>

namespace kacanov {

class Surface;
struct HeightField;

/// A node that may touch.
struct SurfacePoint {
  Vector3 x{};      ///< undeformed
  Vector3 outer{};  ///< the body's outer normal, of any length
};

/// How an obstacle is seen from a point (theory: traces).
struct Facing {
  enum class Kind { met, missed, undecided };
  Vector3 normal{};      ///< ν: unit, from the body towards the obstacle
  double gap = 0.0;      ///< negative within the obstacle
  double unknown = 0.0;  ///< what arithmetic may have left of the gap (theory: gap-rounding)
  double lengths = 0.0;  ///< of the case that the gap is a difference of, each read to double precision
  Kind kind = Kind::met;
  bool chosen = false;  ///< of several directions in which it is equally near (theory: equal-distance)

  static Facing nothing() { return {{}, 0.0, 0.0, 0.0, Kind::missed}; }
  /// The obstacle is as near in several directions: an error of the input.
  static Facing from_everywhere() { return {{}, 0.0, 0.0, 0.0, Kind::undecided}; }
};

// Every obstacle has its key in the case file, what its undecided points are called in messages, `check`,
// which throws InputError about the first parameter that makes no sense, and `project`. `path` is that of its
// key.

struct Plane {
  Vector3 point{}, normal{};  ///< normal to the body's side, any length
  static constexpr const char *key = "plane", *undecided = "";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

struct Sphere {
  Vector3 centre{};
  double radius = 1.0;
  std::optional<Vector3> direction;  ///< from the body towards the obstacle: ν of every node
  bool inside = false;               ///< the body is within; not with `direction`
  static constexpr const char *key = "sphere", *undecided = "at the centre";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// Without ends; in 2D a strip along its axis.
struct Cylinder {
  Vector3 point{}, axis{};  ///< a point of the axis, and its direction
  double radius = 1.0;
  std::optional<Vector3> direction;  ///< as the sphere's
  bool inside = false;               ///< the body is within: a bore
  static constexpr const char *key = "cylinder", *undecided = "on the axis";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// Without a base; in 2D a wedge.
struct Cone {
  Vector3 apex{}, axis{};  ///< the axis leads from the apex into the cone
  double half_angle = 45;  ///< between axis and mantle, degrees
  std::optional<Vector3> direction;
  static constexpr const char *key = "cone", *undecided = "on the axis";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

struct Torus {
  Vector3 centre{}, axis{};
  double radius = 1.0;  ///< of the circle in the tube's middle
  double tube = 0.5;    ///< radius of the tube
  static constexpr const char *key = "torus", *undecided = "on the axis or in the middle of the tube";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// A block, by opposite corners; in 2D the third entries do not count.
struct Block {
  Vector3 lower{}, upper{};
  /// Orthogonal, of any length: what its edges are along, from the lower corner to the upper one. Left out,
  /// the coordinates' axes.
  std::optional<std::array<Vector3, 3>> frame = {};
  bool flat() const;  ///< without a length along the third axis: one for 2D
  static constexpr const char *key = "box", *undecided = "";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// Triangles, by their closest point; outer normals by the order of the corners. 3D only.
struct SurfaceObstacle {
  std::shared_ptr<const Surface> surface;  ///< null: still to be read
  static constexpr const char *key = "surface", *undecided = "where the surface folds back on itself";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// A height z over (x, y), seen along z. 3D only.
struct HeightMap {
  std::shared_ptr<const HeightField> field;  ///< null: still to be read
  bool body_above = true;                    ///< the body is above it, else below
  static constexpr const char *key = "height_map", *undecided = "";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

struct ConstantGap {
  double gap = 0.0;  ///< along the body's outer normal
  static constexpr const char *key = "gap", *undecided = "where the outer normal is zero";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// One that is added has its place here, and its entry in the case file.
using Obstacle =
    std::variant<Plane, Sphere, Cylinder, Cone, Torus, Block, SurfaceObstacle, HeightMap, ConstantGap>;

}  // namespace kacanov
