// SPDX-License-Identifier: BSD-3-Clause
// A surface of triangles, with a tree that finds its closest point.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <kacanov/obstacle.hpp>

namespace kacanov {

/// Points nearer than 1e-7 of the extent are one, so that neighbours know each other. Triangles without
/// area are left out. Immutable.
class Surface {
 public:
  using Triangle = std::array<std::int32_t, 3>;

  /// Outer normals by the right-hand rule. Throws InputError, naming the first triangle from 0, where
  /// coordinates are not finite or points are not there, and where nothing has an area.
  Surface(const std::vector<Vector3>& points, const std::vector<Triangle>& triangles);

  struct Closest {
    Vector3 point{};
    Vector3 way{};     ///< from x to the point, with the digits of a way far shorter than the coordinates
    Vector3 normal{};  ///< unit pseudo-normal of the face, edge or corner it lies in; 0 where faces fold back
    bool border = false;  ///< at an edge that only one triangle has
    Vector3 face{};       ///< unit normal of the triangle itself
  };
  Closest closest(const Vector3& x) const;
  /// The closest points of all triangles that come within `distance`, in the order of the triangles.
  std::vector<Closest> within(const Vector3& x, double distance) const;
  /// The same by looking at every triangle: the plain reference.
  Closest closest_of_all(const Vector3& x) const;

  std::size_t size() const noexcept { return faces_.size(); }
  double extent() const noexcept { return extent_; }  ///< diagonal of the box round it
  const std::vector<Vector3>& points() const noexcept { return points_; }
  Triangle corners(std::size_t face) const noexcept { return faces_[face].corner; }

 private:
  struct Face {
    Triangle corner{};
    Vector3 normal{};               ///< unit
    std::array<Vector3, 3> edge{};  ///< pseudo-normals of the edges 01, 12, 20
    std::array<bool, 3> border{};
  };
  struct Box {
    Vector3 lower{}, upper{};
    double squared_distance(const Vector3& x) const;
  };
  /// A leaf has faces [first, last), an inner node two children, the first right behind it.
  struct TreeNode {
    Box box;
    std::int32_t first = 0, last = 0;
    std::int32_t second_child = -1;  ///< −1: a leaf
  };
  struct Candidate {
    double squared = 0.0;
    std::int32_t face = -1;
    int feature = 0;  ///< 0 the face; 1 to 3 an edge; 4 to 6 a corner
    Vector3 point{};
  };
  void join_points(const std::vector<Vector3>& points, const std::vector<Triangle>& triangles);
  void find_normals();
  std::int32_t build(std::int32_t first, std::int32_t last);
  Candidate closest_on(std::int32_t face, const Vector3& x) const;
  void look_at(std::int32_t face, const Vector3& x, Candidate& best) const;
  /// Calls visit(face) for all that may be within the root of `squared()`, which may fall meanwhile, near
  /// ones first.
  template <class Squared, class Visit>
  void search(const Vector3& x, const Squared& squared, const Visit& visit) const;
  Closest describe(const Candidate& found, const Vector3& x) const;
  Vector3 way_to(const Candidate& found, const Vector3& x) const;

  std::vector<Vector3> points_;
  std::vector<Vector3> corner_normals_;  ///< one a point, weighted by angle
  std::vector<std::uint8_t> border_points_;
  std::vector<Face> faces_;
  std::vector<TreeNode> tree_;
  double extent_ = 0.0;
};

}  // namespace kacanov
