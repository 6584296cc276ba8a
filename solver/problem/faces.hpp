// SPDX-License-Identifier: BSD-3-Clause
// Projection of mesh nodes, and of points between them, onto an obstacle.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/obstacle.hpp>

namespace kacanov {

/// Throws InputError with the obstacle's path ("contact[0].obstacle.sphere") if the obstacle does not fit the
/// mesh or its data are not read yet. Both must outlive it.
class Faces {
 public:
  /// `path`: path of the contact entry.
  Faces(const Mesh& mesh, const Obstacle& obstacle, const std::string& path);

  const std::string& path() const noexcept { return path_; }
  /// Returns the contact direction and gap of a node with the given outer normal (of any length); empty if
  /// the node misses the obstacle. Throws InputError if no direction leads out of the obstacle.
  std::optional<Facing> at(std::int32_t node, const Vector3& outer) const;
  /// The same for a point between nodes; also empty if no direction leads out.
  std::optional<Facing> between(const SurfacePoint& point) const;

 private:
  const Mesh& mesh_;
  const Obstacle& obstacle_;
  std::string path_;
};

/// Unit vectors and cosines that differ by less count as equal.
constexpr double same_direction = 1e-6;

/// The chosen direction, as indices into the list of candidates.
struct FaceChoice {
  std::vector<std::size_t> chosen;  ///< one direction, or several whose mean is used
  bool decides = false;             ///< whether another choice would also have faced the body
};

/// Chooses from the unit directions towards equally near faces, all of which differ, the one closest to the
/// body's outer normal. Of equally close ones it returns all, to be averaged, or, if they cancel, the last
/// one in the order of their components.
FaceChoice choose_face(std::span<const Vector3> directions, const Vector3& outer);

}  // namespace kacanov
