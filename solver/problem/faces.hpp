// SPDX-License-Identifier: BSD-3-Clause
// How an obstacle faces the nodes of a mesh, and what lies between them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/obstacle.hpp>

namespace kacanov {

/// Throws InputError with the obstacle's path ("contact[0].obstacle.sphere") where mesh and obstacle do not
/// go together or its data are not read yet. Both have to outlive it.
class Faces {
 public:
  /// `path`: of the contact entry.
  Faces(const Mesh& mesh, const Obstacle& obstacle, const std::string& path);

  const std::string& path() const noexcept { return path_; }
  /// Of a node whose outer normal (of any length) is given; nothing where the obstacle is missed. Throws
  /// InputError where no direction leads out of the obstacle.
  std::optional<Facing> at(std::int32_t node, const Vector3& outer) const;
  /// The same of a point between nodes, and nothing where no direction leads out.
  std::optional<Facing> between(const SurfacePoint& point) const;

 private:
  const Mesh& mesh_;
  const Obstacle& obstacle_;
  std::string path_;
};

/// The direction that is taken, as places in the list of candidates.
struct FaceChoice {
  std::vector<std::size_t> chosen;  ///< one direction, or several whose mean it is
  bool decides = false;             ///< another choice would have faced the body as well
};

/// Of unit directions from a point towards its equally near faces: the one along the body's outer normal
/// most; of those that are as much so all, to be averaged, or where they cancel the last in the order of
/// their components.
FaceChoice choose_face(std::span<const Vector3> directions, const Vector3& outer);

}  // namespace kacanov
