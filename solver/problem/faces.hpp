// SPDX-License-Identifier: BSD-3-Clause
// How an obstacle faces the nodes of a mesh, and what lies between them.
#pragma once

#include <optional>
#include <string>

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

}  // namespace kacanov
