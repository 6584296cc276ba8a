// SPDX-License-Identifier: BSD-3-Clause
// Obstacles in closed form: what is wrong with one, and how it is seen from a point (theory: traces).
#include <kacanov/obstacle.hpp>

#include <algorithm>
#include <cmath>

#include <kacanov/height_field.hpp>
#include <kacanov/surface.hpp>
#include "problem/model_checks.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

constexpr NumberRule half_angle{"an angle in degrees above 0 and below 90",
                                [](double v) { return v > 0.0 && v < 90.0; }};

Vector3 unit(const Vector3& v) { return (1.0 / norm(v)) * v; }

/// The closest point lies `offset` away; `distance` is what of that is outside.
Facing towards(const Vector3& offset, double distance) { return {(1.0 / norm(offset)) * offset, distance}; }

/// Of a round thing whose middle is `to_middle` away.
Facing round(const Vector3& to_middle, double radius, bool inside) {
  const double distance = norm(to_middle);
  if (!(distance > 0.0)) return Facing::from_everywhere();
  if (inside) return towards(-1.0 * to_middle, radius - distance);
  return towards(to_middle, distance - radius);
}

void check_sides(const std::string& path, const std::optional<Vector3>& direction, bool inside) {
  if (direction) check_direction(path + ".direction", *direction);
  if (direction && inside)
    throw InputError(path + ".direction: expected no direction beside \"inside\": true");
}

/// Where a t² + 2 b t + c falls through zero, being negative within; nothing where it does not.
std::optional<double> first_root(double a, double b, double c) {
  const double inside = b * b - a * c;
  if (!(a > 0.0) || inside < 0.0) return std::nullopt;
  return (-b - std::sqrt(inside)) / a;
}

}  // namespace

void Plane::check(const std::string& path) const {
  kacanov::check(path + ".point", point);
  check_direction(path + ".normal", normal);
}

Facing Plane::project(const SurfacePoint& from) const {
  const Vector3 direction = -1.0 * unit(normal);
  return {direction, dot(point - from.x, direction)};
}

void Sphere::check(const std::string& path) const {
  kacanov::check(path + ".centre", centre);
  kacanov::check(path + ".radius", radius, positive);
  check_sides(path, direction, inside);
}

Facing Sphere::project(const SurfacePoint& from) const {
  const Vector3 to_centre = centre - from.x;
  if (!direction) return round(to_centre, radius, inside);
  const Vector3 way = unit(*direction);
  const double along = dot(to_centre, way);
  const double within = radius * radius - (dot(to_centre, to_centre) - along * along);
  if (within < 0.0) return Facing::nothing();
  return {way, along - std::sqrt(within)};
}

void Cylinder::check(const std::string& path) const {
  kacanov::check(path + ".point", point);
  check_direction(path + ".axis", axis);
  kacanov::check(path + ".radius", radius, positive);
  check_sides(path, direction, inside);
}

Facing Cylinder::project(const SurfacePoint& from) const {
  const Vector3 along = unit(axis);
  const auto across = [&](const Vector3& v) { return v - dot(v, along) * along; };
  const Vector3 to_axis = across(point - from.x);
  if (!direction) return round(to_axis, radius, inside);
  const Vector3 way = unit(*direction), flat = across(way);
  const auto met = first_root(dot(flat, flat), -dot(to_axis, flat), dot(to_axis, to_axis) - radius * radius);
  return met ? Facing{way, *met} : Facing::nothing();
}

void Cone::check(const std::string& path) const {
  kacanov::check(path + ".apex", apex);
  check_direction(path + ".axis", axis);
  kacanov::check(path + ".half_angle", half_angle, kacanov::half_angle);
  if (direction) check_direction(path + ".direction", *direction);
}

Facing Cone::project(const SurfacePoint& from) const {
  const Vector3 along = unit(axis), x = from.x - apex;
  const double angle = half_angle * M_PI / 180.0, sine = std::sin(angle), cosine = std::cos(angle);
  const double height = dot(x, along);
  const Vector3 out = x - height * along;
  const double radius = norm(out);
  if (direction) {
    // Within, cos²|y|² − (y·a)² is negative for y from the apex; so it is in the cone's mirror image.
    const Vector3 way = unit(*direction);
    const double steep = dot(way, along);
    const double a = cosine * cosine - steep * steep, b = cosine * cosine * dot(x, way) - height * steep,
                 c = cosine * cosine * radius * radius - sine * sine * height * height;
    const double within = b * b - a * c;
    if (within < 0.0) return Facing::nothing();
    // The root where it falls is where the ray enters, written so that nothing cancels and a may be 0.
    const double root = std::sqrt(within);
    const double way_in = b > 0.0 ? -(b + root) / a : c / (root - b);
    if (!std::isfinite(way_in) || height + way_in * steep < 0.0) return Facing::nothing();
    return {way, way_in};
  }
  if (height * cosine + radius * sine <= 0.0) {  // nothing is nearer than the apex
    if (!(norm(x) > 0.0)) return {along, 0.0};
    return towards(-1.0 * x, norm(x));
  }
  if (!(radius > 0.0)) return Facing::from_everywhere();
  return {sine * along - (cosine / radius) * out, radius * cosine - height * sine};
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
  const Vector3 along = unit(axis), x = from.x - centre;
  const Vector3 out = x - dot(x, along) * along;
  const double distance = norm(out);
  if (!(distance > 0.0)) return Facing::from_everywhere();
  return round((radius / distance) * out - x, tube, false);
}

void Block::check(const std::string& path) const {
  kacanov::check(path + ".lower", lower);
  kacanov::check(path + ".upper", upper);
  for (std::size_t c = 0; c < 3; ++c)
    if (lower[c] > upper[c] || (c < 2 && lower[c] == upper[c]))
      refuse(path, "a lower corner that is below the upper one in every direction",
             shown_list(lower) + " and " + shown_list(upper));
}

Facing Block::project(const SurfacePoint& from) const {
  const std::size_t dim = lower[2] == upper[2] ? 2 : 3;
  Vector3 offset{};
  double depth = HUGE_VAL;
  for (std::size_t c = 0; c < dim; ++c) {
    offset[c] = std::clamp(from.x[c], lower[c], upper[c]) - from.x[c];
    depth = std::min({depth, from.x[c] - lower[c], upper[c] - from.x[c]});
  }
  const double distance = norm(offset);
  if (distance > 0.0) return towards(offset, distance);
  // Of faces that are as near, as on an edge, the one that the body looks at.
  const double equal = 1e-9 * norm(upper - lower);
  Vector3 face{};
  double opposite = -HUGE_VAL;
  for (std::size_t c = 0; c < dim; ++c)
    for (const double inwards : {1.0, -1.0}) {
      const double below = inwards > 0.0 ? from.x[c] - lower[c] : upper[c] - from.x[c];
      if (below > depth + equal || inwards * from.outer[c] <= opposite) continue;
      opposite = inwards * from.outer[c];
      face = {};
      face[c] = inwards;
    }
  return {face, -depth};
}

void SurfaceObstacle::check(const std::string&) const {}

Facing SurfaceObstacle::project(const SurfacePoint& from) const {
  const Surface::Closest closest = surface->closest(from.x);
  const Vector3 offset = closest.point - from.x;
  const double distance = norm(offset), along = -dot(offset, closest.normal);
  if (closest.normal == Vector3{}) return Facing::from_everywhere();
  // So close by, the offset has no digits to tell a direction with.
  if (distance <= 1e-9 * surface->extent()) return {-1.0 * closest.normal, along};
  // Beyond the border of a surface that is open there is nothing to touch.
  if (closest.border && norm(offset + along * closest.normal) > 1e-6 * distance) return Facing::nothing();
  return along >= 0.0 ? towards(offset, distance) : towards(-1.0 * offset, -distance);
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
  const std::optional<double> height = field->at(from.x[0], from.x[1]);
  if (!height) return Facing::nothing();
  return body_above ? Facing{{0.0, 0.0, -1.0}, from.x[2] - *height}
                    : Facing{{0.0, 0.0, 1.0}, *height - from.x[2]};
}

void ConstantGap::check(const std::string& path) const { kacanov::check(path, gap); }

Facing ConstantGap::project(const SurfacePoint& from) const {
  if (!(norm(from.outer) > 0.0)) return Facing::from_everywhere();
  return {(1.0 / norm(from.outer)) * from.outer, gap};
}

}  // namespace kacanov
