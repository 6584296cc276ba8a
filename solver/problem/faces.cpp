// SPDX-License-Identifier: BSD-3-Clause
// Projection of mesh nodes, and of points between them, onto an obstacle.
#include "problem/faces.hpp"

#include <algorithm>

#include <kacanov/error.hpp>
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Whether this kind of obstacle has a "direction" key that resolves ambiguity.
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

namespace {

/// Cosine with the outer normal above which a face faces the body: that of facet_orientation with the
/// opposite sign.
constexpr double looks_at_body = 0.05;

/// Lexicographic order, by the first components that differ.
bool is_before(const Vector3& a, const Vector3& b) {
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(a[c] - b[c]) > same_direction) return a[c] < b[c];
  return false;
}

}  // namespace

FaceChoice choose_face(std::span<const Vector3> directions, const Vector3& outer) {
  const double length = norm(outer);
  const auto cosine = [&](const Vector3& nu) { return length > 0.0 ? dot(nu, outer) / length : 0.0; };
  double most = -1.0;
  for (const Vector3& nu : directions) most = std::max(most, cosine(nu));
  FaceChoice choice;
  Vector3 sum{};
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Vector3& nu = directions[k];
    if (cosine(nu) < most - same_direction) {
      choice.decides = choice.decides || (cosine(nu) > looks_at_body && most < 1.0 - same_direction);
      continue;
    }
    choice.chosen.push_back(k);
    sum = sum + nu;
  }
  if (choice.chosen.size() < 2) return choice;
  choice.decides = true;
  if (norm(sum) > same_direction * static_cast<double>(choice.chosen.size())) return choice;
  choice.chosen = {*std::max_element(
      choice.chosen.begin(), choice.chosen.end(),
      [&](std::size_t a, std::size_t b) { return is_before(directions[a], directions[b]); })};
  return choice;
}

}  // namespace kacanov
