// SPDX-License-Identifier: BSD-3-Clause
// A triangulated surface with a bounding-box tree for closest-point queries.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <kacanov/obstacle.hpp>

namespace kacanov {

/// Merges points closer than 1e-7 of the extent, so that adjacent triangles share nodes, and drops triangles
/// without area. Immutable.
class Surface {
 public:
  using Triangle = std::array<std::int32_t, 3>;

  /// Outer normals follow the right-hand rule. Throws InputError that names the first bad triangle, counted
  /// from 0: coordinates that are not finite, or corners that do not exist. Also throws if no triangle has an
  /// area.
  Surface(const std::vector<Vector3>& points, const std::vector<Triangle>& triangles);

  struct Closest {
    Vector3 point{};
    Vector3 way{};  ///< vector from x to the point, accurate even if far shorter than the coordinates
    /// Unit pseudo-normal of the face, edge or corner that contains the point; 0 where faces fold back.
    Vector3 normal{};
    bool border = false;  ///< whether the point is on an edge of one triangle only
    Vector3 face{};       ///< unit normal of the triangle itself
  };
  Closest closest(const Vector3& x) const;
  /// Returns the closest points of all triangles within `distance` of x, in the order of the triangles.
  std::vector<Closest> within(const Vector3& x, double distance) const;
  /// The same result by a loop over all triangles: the reference.
  Closest closest_of_all(const Vector3& x) const;

  std::size_t size() const noexcept { return faces_.size(); }
  double extent() const noexcept { return extent_; }  ///< diagonal of the bounding box
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
  /// A leaf holds the faces [first, last); an inner node has two children, the first one directly after it.
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
  /// Calls visit(face) for all faces that may be within √squared(), nearest boxes first; `squared()` may
  /// decrease during the search.
  template <class Squared, class Visit>
  void search(const Vector3& x, const Squared& squared, const Visit& visit) const;
  Closest describe(const Candidate& found, const Vector3& x) const;
  Vector3 way_to(const Candidate& found, const Vector3& x) const;

  std::vector<Vector3> points_;
  std::vector<Vector3> corner_normals_;  ///< one per point, weighted by angle
  std::vector<std::uint8_t> border_points_;
  std::vector<Face> faces_;
  std::vector<TreeNode> tree_;
  double extent_ = 0.0;
};

}  // namespace kacanov
