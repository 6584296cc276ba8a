// SPDX-License-Identifier: BSD-3-Clause
// The obstacle `box`: a block along the coordinate axes or rotated (theory: traces).
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <kacanov/obstacle.hpp>
#include "problem/error_tracking_double.hpp"
#include "problem/faces.hpp"
#include "problem/model_checks.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// A face of the box, through its lower or upper corner.
struct BoxFace {
  TrackedVector inwards{};
  Tracked above;         ///< distance of the projected point above it
  double lengths = 0.0;  ///< sum of the input lengths whose difference is `above`
};

BoxFace box_face(const Vector3& x, const Vector3& corner, const TrackedVector& inwards) {
  const Vector3 way = corner - x, n = values(inwards);
  return {inwards, dot(tracked(corner) - tracked(x), inwards),
          std::abs(way[0] * n[0]) + std::abs(way[1] * n[1]) + std::abs(way[2] * n[2])};
}

}  // namespace

bool Block::flat() const {
  const Vector3 across = frame ? (*frame)[2] : Vector3{0.0, 0.0, 1.0};
  return lower[2] == upper[2] && across[0] == 0.0 && across[1] == 0.0;
}

void Block::check(const std::string& path) const {
  kacanov::check(path + ".lower", lower);
  kacanov::check(path + ".upper", upper);
  if (frame) check_axes(path + ".frame", *frame);
  const Vector3 diagonal = upper - lower;
  // In a rotated frame, corners at the same height along an axis are so only up to rounding.
  const double least = frame ? 1e-12 * norm(diagonal) : 0.0;
  for (std::size_t c = 0; c < (flat() ? 2 : 3); ++c)
    if (!((frame ? dot(diagonal, (*frame)[c]) / norm((*frame)[c]) : diagonal[c]) > least))
      refuse(path,
             std::string("a lower corner that is below the upper one in every direction") +
                 (frame ? " of the frame" : ""),
             shown_list(lower) + " and " + shown_list(upper));
}

Facing Block::project(const SurfacePoint& from) const {
  std::array<BoxFace, 6> faces;
  const std::size_t count = flat() ? 4 : 6;
  for (std::size_t f = 0; f < count; ++f) {
    Vector3 axis{};
    axis[f / 2] = 1.0;
    if (frame) axis = (*frame)[f / 2];
    faces[f] = box_face(from.x, f % 2 == 0 ? lower : upper, Tracked(f % 2 == 0 ? 1.0 : -1.0) * unit(axis));
  }
  // For closer points, the vector to an edge has no significant digits of direction.
  const double equal = 1e-9 * norm(upper - lower);
  TrackedVector offset{};
  double lengths = 0.0;
  Tracked nearest = -HUGE_VAL;
  for (std::size_t f = 0; f < count; ++f) {
    const BoxFace& face = faces[f];
    if (face.above.value() > nearest.value()) nearest = face.above;
    if (!(face.above.value() > 0.0)) continue;
    offset = offset + face.above * face.inwards;
    lengths += face.lengths;
  }
  if (nearest.value() > equal) {
    const Tracked distance = norm(offset);
    return facing(Tracked(1.0) / distance * offset, distance, lengths);
  }
  std::vector<BoxFace> candidates;
  std::vector<Vector3> directions;
  for (std::size_t f = 0; f < count; ++f) {
    if (faces[f].above.value() < nearest.value() - equal) continue;
    candidates.push_back(faces[f]);
    directions.push_back(values(faces[f].inwards));
  }
  const FaceChoice choice = choose_face(directions, from.outer);
  const BoxFace& first = candidates[choice.chosen.front()];
  Facing found = facing(first.inwards, first.above, first.lengths);
  if (choice.chosen.size() > 1) {
    TrackedVector sum{};
    double longest = 0.0;
    for (const std::size_t k : choice.chosen) {
      sum = sum + candidates[k].inwards;
      longest = std::max(longest, candidates[k].lengths);
    }
    // Along the mean of orthogonal normals, the distance to all their faces is the same.
    const TrackedVector mean = unit(sum);
    found = facing(mean, first.above / dot(mean, first.inwards), longest);
  }
  found.chosen = choice.decides;
  return found;
}

}  // namespace kacanov
