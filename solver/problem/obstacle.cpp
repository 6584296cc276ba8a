// SPDX-License-Identifier: BSD-3-Clause
// Parameter checks and projections of obstacles in closed form (theory: traces).
#include <kacanov/obstacle.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <kacanov/surface.hpp>
#include "problem/error_tracking_double.hpp"
#include "problem/faces.hpp"
#include "problem/model_checks.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Relative rounding error of a length computed in a few steps from lengths of this size.
constexpr double some_roundings = 1e-15;

/// Whether a vector of this length has a significant direction.
bool leads_somewhere(const Tracked& length) { return length.value() > 1e12 * length.error(); }

/// Projects onto a sphere or circle whose centre is at `to_middle` from the point.
Facing round(const TrackedVector& to_middle, double radius, bool inside) {
  const Tracked distance = norm(to_middle);
  if (!leads_somewhere(distance)) return Facing::from_everywhere();
  const Tracked side = inside ? -1.0 : 1.0;
  return facing(side / distance * to_middle, side * (distance - radius), distance.value() + radius);
}

/// Relative to the extent of a surface: direction vectors of closer points have no significant digits.
constexpr double on_surface = 1e-9;
/// Relative to the extent: faces whose distances differ by less are equally near, because single-precision
/// files resolve their corners no better.
constexpr double equally_near = 1e-7;

/// Projection onto one triangle of a surface.
struct SeenTriangle {
  Facing facing;
  bool by_plane = false;  ///< along its normal
};

/// Projects onto the closest point, or onto the plane if the point is on the surface or above the inside of
/// the triangle.
std::optional<SeenTriangle> seen_triangle(const Surface::Closest& closest, bool touches) {
  const Vector3& offset = closest.way;
  const double above = -dot(offset, closest.face), distance = norm(offset);
  if (touches) return SeenTriangle{{-1.0 * closest.face, above}, true};
  if (closest.normal == Vector3{}) return std::nullopt;
  const double along = -dot(offset, closest.normal);
  // Beyond the border of an open surface there is nothing to touch.
  if (closest.border && norm(offset + along * closest.normal) > same_direction * distance)
    return std::nullopt;
  const double side = along >= 0.0 ? 1.0 : -1.0;
  if (norm(offset + above * closest.face) <= same_direction * distance)
    return SeenTriangle{{(above >= 0.0 ? -side : side) * closest.face, side * distance}, true};
  return SeenTriangle{{side / distance * offset, side * distance}, false};
}

/// Returns one projection per direction, that with the least gap; plane projections take the mean of their
/// normals. The result does not depend on the order of equal triangles, which rounding decides.
std::vector<Facing> one_of_each_direction(std::vector<SeenTriangle> seen) {
  std::stable_sort(seen.begin(), seen.end(),
                   [](const SeenTriangle& a, const SeenTriangle& b) { return a.facing.gap < b.facing.gap; });
  struct Group {
    SeenTriangle first;
    Vector3 sum;
  };
  std::vector<Group> groups;
  for (const SeenTriangle& one : seen) {
    const Vector3& normal = one.facing.normal;
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& other) {
      return norm(other.first.facing.normal - normal) <= same_direction;
    });
    if (group == groups.end()) {
      groups.push_back({one, normal});
    } else if (one.by_plane && !group->first.by_plane) {
      group->first.by_plane = true;
      group->sum = normal;
    } else if (one.by_plane == group->first.by_plane) {
      group->sum = group->sum + normal;
    }
  }
  std::vector<Facing> out;
  for (Group& group : groups) {
    group.first.facing.normal = (1.0 / norm(group.sum)) * group.sum;
    out.push_back(group.first.facing);
  }
  return out;
}

/// Returns the chosen projection of several equally near ones; along a mean of directions it leads to the
/// first of their faces' planes.
Facing facing_of_choice(const std::vector<Facing>& equal, const FaceChoice& choice) {
  Facing found = equal[choice.chosen.front()];
  if (choice.chosen.size() > 1) {
    Vector3 sum{};
    for (const std::size_t k : choice.chosen) sum = sum + equal[k].normal;
    found.normal = (1.0 / norm(sum)) * sum;
    found.gap = HUGE_VAL;
    for (const std::size_t k : choice.chosen) {
      const double cosine = dot(found.normal, equal[k].normal);
      if (const double gap = equal[k].gap / cosine; gap < found.gap)
        found.gap = gap, found.unknown = equal[k].unknown / cosine;
    }
  }
  found.chosen = choice.decides;
  return found;
}

void check_sides(const std::string& path, const std::optional<Vector3>& direction, bool inside) {
  if (direction) check_direction(path + ".direction", *direction);
  if (direction && inside)
    throw InputError(path + ".direction: expected no direction beside \"inside\": true");
}

/// Returns the first root of a t² + 2 b t + c, where it becomes negative; empty if it has none.
std::optional<Tracked> first_root(const Tracked& a, const Tracked& b, const Tracked& c) {
  const Tracked inside = b * b - a * c;
  if (!(a.value() > 0.0) || inside.value() < 0.0) return std::nullopt;
  return (-b - sqrt(inside)) / a;
}

}  // namespace

void Plane::check(const std::string& path) const {
  kacanov::check(path + ".point", point);
  check_direction(path + ".normal", normal);
}

Facing Plane::project(const SurfacePoint& from) const {
  const TrackedVector direction = Tracked(-1.0) * unit(normal);
  const Vector3 way = point - from.x, nu = values(direction);
  const double lengths = std::abs(way[0] * nu[0]) + std::abs(way[1] * nu[1]) + std::abs(way[2] * nu[2]);
  return facing(direction, dot(tracked(point) - tracked(from.x), direction), lengths);
}

void Sphere::check(const std::string& path) const {
  kacanov::check(path + ".centre", centre);
  kacanov::check(path + ".radius", radius, positive);
  check_sides(path, direction, inside);
}

Facing Sphere::project(const SurfacePoint& from) const {
  const TrackedVector to_centre = tracked(centre) - tracked(from.x);
  if (!direction) return round(to_centre, radius, inside);
  const TrackedVector way = unit(*direction);
  const Tracked along = dot(to_centre, way);
  const Tracked within = Tracked(radius) * radius - (dot(to_centre, to_centre) - along * along);
  if (within.value() < 0.0) return Facing::nothing();
  return facing(way, along - sqrt(within), std::abs(along.value()) + radius);
}

void Cylinder::check(const std::string& path) const {
  kacanov::check(path + ".point", point);
  check_direction(path + ".axis", axis);
  kacanov::check(path + ".radius", radius, positive);
  check_sides(path, direction, inside);
}

Facing Cylinder::project(const SurfacePoint& from) const {
  const TrackedVector along = unit(axis);
  const auto across = [&](const TrackedVector& v) { return v - dot(v, along) * along; };
  const TrackedVector to_axis = across(tracked(point) - tracked(from.x));
  if (!direction) return round(to_axis, radius, inside);
  const TrackedVector way = unit(*direction), flat = across(way);
  const auto met =
      first_root(dot(flat, flat), -dot(to_axis, flat), dot(to_axis, to_axis) - Tracked(radius) * radius);
  return met ? facing(way, *met, norm(to_axis).value() + radius) : Facing::nothing();
}

void Cone::check(const std::string& path) const {
  kacanov::check(path + ".apex", apex);
  check_direction(path + ".axis", axis);
  kacanov::check(path + ".half_angle", half_angle, cone_angle);
  if (direction) check_direction(path + ".direction", *direction);
}

Facing Cone::project(const SurfacePoint& from) const {
  // Sine and cosine are accurate to long double.
  constexpr long double pi = 3.141592653589793238462643383279502884L;
  constexpr long double known = 4 * std::numeric_limits<long double>::epsilon();
  const long double angle = static_cast<long double>(half_angle) * pi / 180;
  const Tracked sine = Tracked::known_to(std::sin(angle), known);
  const Tracked cosine = Tracked::known_to(std::cos(angle), known);
  const TrackedVector along = unit(axis), x = tracked(from.x) - tracked(apex);
  const Tracked height = dot(x, along);
  const TrackedVector out = x - height * along;
  const Tracked radius = norm(out);
  if (direction) {
    // Inside the cone, and inside its mirror image, cos²|y|² − (y·a)² is negative for y measured from the
    // apex.
    const TrackedVector way = unit(*direction);
    const Tracked steep = dot(way, along), cosine2 = cosine * cosine;
    const Tracked a = cosine2 - steep * steep, b = cosine2 * dot(x, way) - height * steep,
                  c = cosine2 * radius * radius - sine * sine * height * height;
    const Tracked within = b * b - a * c;
    if (within.value() < 0.0) return Facing::nothing();
    // The root at which the sign becomes negative is the entry point; this form avoids cancellation and
    // allows a = 0.
    const Tracked root = sqrt(within);
    const Tracked way_in = b.value() > 0.0 ? -(b + root) / a : c / (root - b);
    if (!std::isfinite(way_in.value()) || (height + way_in * steep).value() < 0.0) return Facing::nothing();
    return facing(way, way_in, norm(x).value());
  }
  if ((height * cosine + radius * sine).value() <= 0.0) {  // the apex is the nearest point
    const Tracked distance = norm(x);
    if (!(distance.value() > 0.0)) return facing(along, 0.0, 0.0);
    return facing(Tracked(-1.0) / distance * x, distance, 0.0);
  }
  if (!leads_somewhere(radius)) return Facing::from_everywhere();
  return facing(sine * along - cosine / radius * out, radius * cosine - height * sine,
                radius.value() + std::abs(height.value()));
}

void Torus::check(const std::string& path) const {
  kacanov::check(path + ".centre", centre);
  check_direction(path + ".axis", axis);
  kacanov::check(path + ".radius", radius, positive);
  kacanov::check(path + ".tube", tube, positive);
  if (!(tube < radius))
    refuse(path + ".tube", "a radius below that of the torus, " + shown(radius), shown(tube));
}

Facing Torus::project(const SurfacePoint& from) const {
  const TrackedVector along = unit(axis), x = tracked(from.x) - tracked(centre);
  const TrackedVector out = x - dot(x, along) * along;
  const Tracked distance = norm(out);
  if (!leads_somewhere(distance)) return Facing::from_everywhere();
  Facing found = round(Tracked(radius) / distance * out - x, tube, false);
  found.lengths += distance.value() + radius;
  return found;
}

void SurfaceObstacle::check(const std::string&) const {}

Facing SurfaceObstacle::project(const SurfacePoint& from) const {
  const Surface::Closest closest = surface->closest(from.x);
  if (closest.normal == Vector3{}) return Facing::from_everywhere();
  const double extent = surface->extent(), distance = norm(closest.way);
  const bool touches = distance <= on_surface * extent;
  const double reach = touches ? on_surface * extent : distance + equally_near * extent;
  std::vector<SeenTriangle> seen;
  for (const Surface::Closest& one : surface->within(from.x, reach)) {
    std::optional<SeenTriangle> triangle = seen_triangle(one, touches);
    if (!triangle) continue;
    // The closest point is computed from corners whose coordinates may be as large as the surface.
    triangle->facing.unknown = some_roundings * (norm(from.x) + norm(one.point) + extent);
    seen.push_back(*triangle);
  }
  if (seen.empty()) return Facing::nothing();
  const std::vector<Facing> equal = one_of_each_direction(std::move(seen));
  std::vector<Vector3> directions;
  for (const Facing& one : equal) directions.push_back(one.normal);
  return facing_of_choice(equal, choose_face(directions, from.outer));
}

void HeightMap::check(const std::string& path) const {
  if (!field) return;
  for (std::size_t c = 0; c < 2; ++c) {
    kacanov::check(at(path + ".lower", c), field->lower[c]);
    kacanov::check(at(path + ".upper", c), field->upper[c]);
    if (!(field->lower[c] < field->upper[c]))
      refuse(at(path + ".upper", c), "a number above that of the lower corner, " + shown(field->lower[c]),
             shown(field->upper[c]));
  }
  if (field->rows < 2 || field->columns < 2 || field->height.size() != field->rows * field->columns)
    throw InputError(path + ": expected at least 2 × 2 heights");
  for (const double height : field->height)
    if (!(std::abs(height) <= largest_number))
      refuse(path, "heights of a magnitude below 1e100", shown(height));
}

Facing HeightMap::project(const SurfacePoint& from) const {
  const auto height = field->at(from.x[0], from.x[1]);
  if (!height) return Facing::nothing();
  const double above = from.x[2] - height->value;
  const double unknown = height->unknown + some_roundings * std::abs(above);
  return body_above ? Facing{{0.0, 0.0, -1.0}, above, unknown} : Facing{{0.0, 0.0, 1.0}, -above, unknown};
}

void ConstantGap::check(const std::string& path) const { kacanov::check(path, gap); }

Facing ConstantGap::project(const SurfacePoint& from) const {
  if (!(norm(from.outer) > 0.0)) return Facing::from_everywhere();
  return {(1.0 / norm(from.outer)) * from.outer, gap, 0.0};
}

}  // namespace kacanov
