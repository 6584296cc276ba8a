// SPDX-License-Identifier: BSD-3-Clause
// Rigid obstacles and their projections: normal and gap as seen from a point of the body's surface.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <kacanov/vector3.hpp>

namespace kacanov {

class Surface;
struct HeightField;

/// A node that may come into contact.
struct SurfacePoint {
  Vector3 x{};      ///< undeformed position
  Vector3 outer{};  ///< the body's outer normal, of any length
};

/// Contact direction and gap of an obstacle as seen from a point (theory: traces).
struct Facing {
  enum class Kind { met, missed, undecided };
  Vector3 normal{};      ///< ν: unit, from the body towards the obstacle
  double gap = 0.0;      ///< negative inside the obstacle
  double unknown = 0.0;  ///< bound on the rounding error of the gap (theory: gap-rounding)
  /// Sum of the input lengths whose difference is the gap, each read to double precision.
  double lengths = 0.0;
  Kind kind = Kind::met;
  bool chosen = false;  ///< whether several directions were equally near (theory: equal-distance)

  static Facing nothing() { return {{}, 0.0, 0.0, 0.0, Kind::missed}; }
  /// The obstacle is equally near in several directions and none can be chosen: an input error.
  static Facing from_everywhere() { return {{}, 0.0, 0.0, 0.0, Kind::undecided}; }
};

// Every obstacle defines its key in the case file, the words for its undecided points in messages, `check`,
// which throws InputError for the first invalid parameter (`path` is the path of its key), and `project`.

struct Plane {
  Vector3 point{}, normal{};  ///< normal towards the body's side, of any length
  static constexpr const char *key = "plane", *undecided = "";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

struct Sphere {
  Vector3 centre{};
  double radius = 1.0;
  std::optional<Vector3> direction;  ///< from the body towards the obstacle: ν of every node
  bool inside = false;               ///< the body is inside the sphere; not with `direction`
  static constexpr const char *key = "sphere", *undecided = "at the centre";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// Infinite; in 2D a strip along its axis.
struct Cylinder {
  Vector3 point{}, axis{};  ///< a point on the axis, and the axis direction
  double radius = 1.0;
  std::optional<Vector3> direction;  ///< as for Sphere
  bool inside = false;               ///< the body is inside: a bore
  static constexpr const char *key = "cylinder", *undecided = "on the axis";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// Infinite, without a base; in 2D a wedge.
struct Cone {
  Vector3 apex{}, axis{};  ///< the axis points from the apex into the cone
  double half_angle = 45;  ///< between axis and lateral surface, in degrees
  std::optional<Vector3> direction;
  static constexpr const char *key = "cone", *undecided = "on the axis";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

struct Torus {
  Vector3 centre{}, axis{};
  double radius = 1.0;  ///< of the circle at the tube's centre
  double tube = 0.5;    ///< radius of the tube
  static constexpr const char *key = "torus", *undecided = "on the axis or in the middle of the tube";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// A block given by opposite corners; in 2D the third components are ignored.
struct Block {
  Vector3 lower{}, upper{};
  /// Orthogonal directions, of any length, of its edges from the lower to the upper corner. Unset: the
  /// coordinate axes.
  std::optional<std::array<Vector3, 3>> frame = {};
  bool flat() const;  ///< whether it has no extent along the third axis: a 2D block
  static constexpr const char *key = "box", *undecided = "";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// A triangulated surface, evaluated at the closest point; corner order defines the outer normals. 3D only.
struct SurfaceObstacle {
  std::shared_ptr<const Surface> surface;  ///< null: not read yet
  static constexpr const char *key = "surface", *undecided = "where the surface folds back on itself";
  void check(const std::string& path) const;
  Facing project(const SurfacePoint& from) const;
};

/// A height z over (x, y); the contact direction is along z. 3D only.
struct HeightMap {
  std::shared_ptr<const HeightField> field;  ///< null: not read yet
  bool body_above = true;                    ///< whether the body is above it; otherwise below
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

/// A new obstacle needs its place in this variant and its entry in the case file.
using Obstacle =
    std::variant<Plane, Sphere, Cylinder, Cone, Torus, Block, SurfaceObstacle, HeightMap, ConstantGap>;

/// `rows` × `columns` heights, at least 2 × 2; the first row has the largest y, as in a picture. The corner
/// values lie at the corners of [lower, upper].
struct HeightField {
  std::size_t rows = 0, columns = 0;
  std::vector<double> height;
  std::array<double, 2> lower{}, upper{};

  struct Height {
    double value = 0.0;
    double unknown = 0.0;  ///< bound on its rounding error
  };
  /// Returns the interpolated height; empty outside the grid, with a tolerance of 1e-9 of its size.
  std::optional<Height> at(double x, double y) const;
};

}  // namespace kacanov
