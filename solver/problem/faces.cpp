// SPDX-License-Identifier: BSD-3-Clause
// How an obstacle faces the nodes of a mesh, and what lies between them.
#include "problem/faces.hpp"

#include <kacanov/error.hpp>
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Whether obstacles of this kind can be told from where they are met.
template <class Kind>
constexpr bool has_direction(const Kind&) {
  return requires(const Kind& kind) { kind.direction; };
}

}  // namespace

Faces::Faces(const Mesh& mesh, const Obstacle& obstacle, const std::string& path)
    : mesh_(mesh), obstacle_(obstacle), path_(path + ".obstacle.") {
  std::visit([&](const auto& kind) { path_ += kind.key; }, obstacle_);
  const auto* surface = std::get_if<SurfaceObstacle>(&obstacle);
  const auto* heights = std::get_if<HeightMap>(&obstacle);
  if ((surface != nullptr && !surface->surface) || (heights != nullptr && !heights->field))
    throw InputError(path_ + ": expected the obstacle's data, which are not read yet");
  if (mesh.dim() == 2) {
    if (surface != nullptr || heights != nullptr)
      throw InputError(path_ + ": expected a mesh in 3D, the only ones that this obstacle faces");
    return;
  }
  const auto* block = std::get_if<Block>(&obstacle);
  if (block != nullptr && block->flat())
    throw InputError(path_ + ": expected corners of three entries that differ in all of them");
}

std::optional<Facing> Faces::at(std::int32_t node, const Vector3& outer) const {
  const SurfacePoint point{position(mesh_, node), outer};
  return std::visit(
      [&](const auto& kind) -> std::optional<Facing> {
        const Facing facing = kind.project(point);
        if (facing.kind == Facing::Kind::met) return facing;
        if (facing.kind == Facing::Kind::missed) return std::nullopt;
        throw InputError(path_ + ": node " + std::to_string(mesh_.node_tag(node)) + " lies " +
                         kind.undecided + ", where no direction leads out; " +
                         (has_direction(kind) ? "give a \"direction\"" : "move the obstacle or the node"));
      },
      obstacle_);
}

std::optional<Facing> Faces::between(const SurfacePoint& point) const {
  const Facing facing = std::visit([&](const auto& kind) { return kind.project(point); }, obstacle_);
  if (facing.kind != Facing::Kind::met) return std::nullopt;
  return facing;
}

}  // namespace kacanov
