// SPDX-License-Identifier: BSD-3-Clause
// Gap and normal between a node and an obstacle (theory: traces, surface-distance).
#include "verify/obstacle.hpp"

#include <algorithm>
#include <map>

#include "verify/height_map.hpp"
#include "verify/problem.hpp"
#include "verify/wide.hpp"

namespace kacanov::verify {
namespace {

using nlohmann::json;

constexpr Real unsure = 1e-13L;
/// Relative round-off of a gap, here and in the program, per length it is a difference of: for closed forms,
/// for sines in long double, for the program's double precision.
constexpr Real closed = some_wide_roundings, with_sines = 1e-18L, in_double = 1e-15L;

Vec unit(const Vec& v) { return 1 / norm(v) * v; }
Real number(const json& object, const char* key) { return object.at(key).get<double>(); }
WideVec wide_vector(const json& list) { return wide(read_vector(list)); }

Facing facing(const WideVec& normal, Wide gap) { return {narrow(normal), static_cast<Real>(gap)}; }

Facing point_like(const WideVec& to_middle, Real radius, bool inside) {
  const Wide far = length(to_middle), side = inside ? -1 : 1;
  return facing(scaled(side / far, to_middle), side * (far - radius));
}

/// Distance along `direction` to the first zero of a t² + 2 b t + c.
Facing along_ray(const WideVec& direction, Wide a, Wide b, Wide c, Wide scale) {
  const Wide inside = b * b - a * c, least = unsure * scale, base = root(inside);
  Facing found = facing(direction, b > 0 ? -(b + base) / a : c / (base - b));
  found.missed = inside < -least;
  found.grazing = inside <= least && inside >= -least;
  return found;
}

/// Directions that differ by less count as equal.
constexpr Real one_direction = 1e-6L;

/// One of several equally near faces.
struct NearFace : Facing {
  bool plane = false;  ///< the direction is a plane normal rather than the direction to a point
};

/// Merges equal directions, keeping the least gap. The merged direction is the mean of the plane normals, if
/// there are any.
std::vector<Facing> by_direction(std::vector<NearFace> faces) {
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Facing& a, const Facing& b) { return a.gap < b.gap; });
  std::vector<NearFace> kept;
  std::vector<Vec> sums;
  for (const NearFace& face : faces) {
    std::size_t k = 0;
    while (k < kept.size() && norm(kept[k].normal - face.normal) > one_direction) ++k;
    if (k == kept.size()) {
      kept.push_back(face);
      sums.push_back(face.normal);
    } else if (face.plane == kept[k].plane) {
      sums[k] = sums[k] + face.normal;
    } else if (face.plane) {
      kept[k].plane = true;
      sums[k] = face.normal;
    }
  }
  for (std::size_t k = 0; k < kept.size(); ++k) kept[k].normal = unit(sums[k]);
  return {kept.begin(), kept.end()};
}

/// Selects among equally near faces the one most aligned with the outward normal; of several such, their
/// mean, up to the first of their planes; if the mean cancels, the last one in the order of components
/// (theory: equal-distance).
Facing most_opposed(std::vector<NearFace> faces, const Vec& outer) {
  constexpr Real same = one_direction;
  const Real size = norm(outer);
  const auto turned = [&](const Facing& face) { return size > 0 ? dot(face.normal, outer) / size : Real(0); };
  const std::vector<Facing> distinct = by_direction(std::move(faces));
  Real best = -1;
  for (const Facing& face : distinct) best = std::max(best, turned(face));
  std::vector<Facing> alike;
  for (const Facing& face : distinct)
    if (turned(face) >= best - same) alike.push_back(face);
  if (alike.size() == 1) return alike[0];
  Vec sum{};
  for (const Facing& face : alike) sum = sum + face.normal;
  if (norm(sum) <= same * Real(alike.size()))
    return *std::max_element(alike.begin(), alike.end(), [&](const Facing& a, const Facing& b) {
      std::size_t c = 0;
      while (c < 2 && std::abs(a.normal[c] - b.normal[c]) <= same) ++c;
      return a.normal[c] < b.normal[c];
    });
  Facing mean = alike[0];
  mean.normal = unit(sum);
  mean.gap = HUGE_VALL;
  for (const Facing& face : alike) {
    const Real cosine = dot(mean.normal, face.normal);
    if (const Real gap = face.gap / cosine; gap < mean.gap)
      mean.gap = gap, mean.unknown = face.unknown / cosine;
  }
  return mean;
}

Face plane(const json& given) {
  const WideVec nu = scaled(-1, unit(wide_vector(given.at("normal")))),
                point = wide_vector(given.at("point"));
  return [=](const Vec& x, const Vec&) {
    const WideVec way = point - wide(x);
    Facing found = facing(nu, inner(way, nu));
    for (std::size_t c = 0; c < 3; ++c) found.unknown += closed * std::abs(static_cast<Real>(way[c] * nu[c]));
    return found;
  };
}

/// A sphere, or a cylinder around its axis.
Face round_thing(const json& given, const char* middle, const WideVec& axis) {
  const WideVec centre = wide_vector(given.at(middle));
  const Real radius = number(given, "radius");
  const bool inside = given.value("inside", false), ray = given.contains("direction");
  const WideVec direction = ray ? unit(wide_vector(given.at("direction"))) : WideVec{};
  return [=](const Vec& x, const Vec&) {
    const auto across = [&](const WideVec& v) { return v - scaled(inner(v, axis), axis); };
    const WideVec to_middle = across(centre - wide(x)), flat = across(direction);
    if (!ray) return point_like(to_middle, radius, inside);
    const Wide a = inner(flat, flat), far = inner(to_middle, to_middle), square = Wide(radius) * radius;
    if (!(a > 0)) return Facing{{}, 0, true};
    return along_ray(direction, a, -inner(to_middle, flat), far - square, a * (square + far));
  };
}

Face cone(const json& given) {
  const WideVec apex = wide_vector(given.at("apex")), axis = unit(wide_vector(given.at("axis")));
  const Real angle = number(given, "half_angle") * std::acos(Real(-1)) / 180;
  const Wide s = std::sin(angle), c = std::cos(angle);
  const bool ray = given.contains("direction");
  const WideVec direction = ray ? unit(wide_vector(given.at("direction"))) : WideVec{};
  return [=](const Vec& x, const Vec&) {
    const WideVec v = wide(x) - apex;
    const Wide up = inner(v, axis);
    const WideVec out = v - scaled(up, axis);
    const Wide radius = length(out);
    if (ray) {
      const Wide steep = inner(direction, axis), size = inner(v, v);
      Facing found = along_ray(direction, c * c - steep * steep, c * c * inner(v, direction) - up * steep,
                               c * c * radius * radius - s * s * up * up, size);
      const Real height = static_cast<Real>(up + found.gap * steep);
      if (!std::isfinite(found.gap) || height < 0) found.missed = true;
      found.grazing = found.grazing || std::abs(height) <= unsure * static_cast<Real>(root(size));
      return found;
    }
    // The nearest point of the generator, in the half-plane of the axis and x, is the apex or an inner point.
    if (up * c + radius * s > 0)
      return facing(scaled(s, axis) - scaled(c / radius, out), radius * c - up * s);
    const Wide away = length(v);
    return away > 0 ? facing(scaled(-1 / away, v), away) : facing(axis, 0);
  };
}

Face torus(const json& given) {
  const WideVec centre = wide_vector(given.at("centre")), axis = unit(wide_vector(given.at("axis")));
  const Real radius = number(given, "radius"), tube = number(given, "tube");
  return [=](const Vec& x, const Vec&) {
    const WideVec v = wide(x) - centre, out = v - scaled(inner(v, axis), axis);
    return point_like(scaled(radius, unit(out)) - v, tube, false);
  };
}

Face block(const json& given) {
  const WideVec lower = wide_vector(given.at("lower")), upper = wide_vector(given.at("upper"));
  std::array<WideVec, 3> axes{WideVec{{1, 0, 0}}, WideVec{{0, 1, 0}}, WideVec{{0, 0, 1}}};
  if (given.contains("frame"))
    for (std::size_t a = 0; a < given.at("frame").size(); ++a)
      axes[a] = unit(wide_vector(given.at("frame").at(a)));
  const bool flat = lower[2] == upper[2] && axes[2][0] == 0 && axes[2][1] == 0;
  const Real close = 1e-9L * static_cast<Real>(length(upper - lower));
  return [=](const Vec& x, const Vec& outer) {
    std::vector<NearFace> faces;  // one per face, along its inward normal; the gap is negative inside
    Real highest = -HUGE_VALL, unknown = 0;
    WideVec way{};
    for (std::size_t a = 0; a < (flat ? 2 : 3); ++a)
      for (const Wide side : {Wide(-1), Wide(1)}) {
        const WideVec from = (side < 0 ? lower : upper) - wide(x);
        const Wide below = side * inner(from, axes[a]);
        Facing face = facing(scaled(-side, axes[a]), -below);
        for (std::size_t c = 0; c < 3; ++c)
          face.unknown += closed * std::abs(static_cast<Real>(from[c] * axes[a][c]));
        faces.push_back({face, true});
        highest = std::max(highest, face.gap);
        if (!(below < 0)) continue;
        unknown += face.unknown;
        way = way - scaled(-side * below, axes[a]);
      }
    if (highest > close) {
      const Wide far = length(way);
      Facing found = facing(scaled(1 / far, way), far);
      found.unknown = unknown;
      return found;
    }
    std::erase_if(faces, [&](const Facing& face) { return face.gap < highest - close; });
    return most_opposed(faces, outer);
  };
}

/// Tests every triangle, distant ones by their bounding sphere only.
class Facets {
 public:
  explicit Facets(std::vector<Triangle> triangles) {
    join(triangles);
    for (const Triangle& t : triangles) {
      const Vec normal = cross(t[1] - t[0], t[2] - t[0]);
      if (!(norm(normal) > 0)) continue;
      Facet facet{t, unit(normal), Real(1) / 3 * (t[0] + t[1] + t[2]), 0};
      for (std::size_t k = 0; k < 3; ++k) {
        facet.radius = std::max(facet.radius, norm(t[k] - facet.middle));
        const Vec a = unit(t[(k + 1) % 3] - t[k]), b = unit(t[(k + 2) % 3] - t[k]);
        Vec& corner = corners_[t[k]];
        corner = corner + std::atan2(norm(cross(a, b)), dot(a, b)) * facet.normal;
        Edge& edge = edges_[key(t[k], t[(k + 1) % 3])];
        edge.normal = edge.normal + facet.normal;
        ++edge.facets;
      }
      facets_.push_back(facet);
    }
    for (const auto& [ends, edge] : edges_)
      if (edge.facets == 1) border_[ends.first] = border_[ends.second] = true;
  }

  Facing face(const Vec& x, const Vec& outer) const {
    Real nearest = HUGE_VALL;
    for (const Facet& facet : facets_)
      if (norm(x - facet.middle) - facet.radius <= nearest)
        nearest = std::min(nearest, closest_on(facet, x).distance);
    const Real extent = norm(high_ - low_);
    const bool touches = nearest <= 1e-9L * extent;
    const Real reach = touches ? 1e-9L * extent : nearest + 1e-7L * extent;
    std::vector<NearFace> faces;
    bool grazing = false;
    for (const Facet& facet : facets_) {
      if (norm(x - facet.middle) - facet.radius > reach) continue;
      const Closest closest = closest_on(facet, x);
      if (closest.distance > reach) continue;
      const Vec way = closest.point - x;
      if (touches) {
        faces.push_back({{-1 * facet.normal, -dot(way, facet.normal)}, true});
        continue;
      }
      if (!(norm(closest.normal) > 0)) continue;
      const Vec normal = unit(closest.normal);
      const Real above = -dot(way, normal), beside = norm(way + above * normal);
      if (closest.border && std::abs(beside - 1e-6L * closest.distance) <= 1e-9L * closest.distance)
        grazing = true;
      if (closest.border && beside > 1e-6L * closest.distance) continue;
      const Real side = above < 0 ? -1 : 1;
      const Real over = -dot(way, facet.normal);
      if (norm(way + over * facet.normal) <= one_direction * closest.distance)
        faces.push_back({{(over < 0 ? side : -side) * facet.normal, side * closest.distance}, true});
      else
        faces.push_back({{side / closest.distance * way, side * closest.distance}, false});
    }
    Facing found;
    if (faces.empty())
      found.missed = true;
    else
      found = most_opposed(faces, outer);
    found.grazing = grazing;
    return found;
  }

 private:
  struct Facet {
    Triangle corner;
    Vec normal, middle;
    Real radius;
  };
  struct Edge {
    Vec normal{};
    int facets = 0;
  };
  struct Closest {
    Real distance = HUGE_VALL;
    Vec point{}, normal{};
    bool border = false;
  };
  /// Merges corners closer than 1e-7 of the extent: all get the coordinates of the first.
  void join(std::vector<Triangle>& triangles) {
    std::vector<Vec*> corners;
    for (Triangle& t : triangles)
      for (Vec& x : t) {
        corners.push_back(&x);
        for (std::size_t c = 0; c < 3; ++c) {
          low_[c] = std::min(low_[c], x[c]);
          high_[c] = std::max(high_[c], x[c]);
        }
      }
    const Real reach = 1e-7L * norm(high_ - low_);
    std::stable_sort(corners.begin(), corners.end(), [](const Vec* a, const Vec* b) { return *a < *b; });
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t j = i; j-- > 0 && (*corners[i])[0] - (*corners[j])[0] <= reach;)
        if (norm(*corners[i] - *corners[j]) <= reach) {
          *corners[i] = *corners[j];
          break;
        }
  }
  static std::pair<Vec, Vec> key(const Vec& a, const Vec& b) { return {std::min(a, b), std::max(a, b)}; }

  /// Returns the foot of the perpendicular if it is inside, else the nearest point on the edges, else the
  /// nearest corner.
  Closest closest_on(const Facet& facet, const Vec& x) const {
    const Triangle& t = facet.corner;
    const Vec foot = x - dot(x - t[0], facet.normal) * facet.normal;
    bool within = true;
    for (std::size_t k = 0; k < 3; ++k)
      within = within && dot(cross(t[(k + 1) % 3] - t[k], foot - t[k]), facet.normal) > 0;
    if (within) return {norm(x - foot), foot, facet.normal, false};
    Closest best;
    const auto take = [&](const Vec& point, const Vec& normal, bool border) {
      if (const Real distance = norm(x - point); distance < best.distance)
        best = {distance, point, normal, border};
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec &a = t[k], &b = t[(k + 1) % 3];
      const Real share = dot(x - a, b - a) / dot(b - a, b - a);
      if (share > 0 && share < 1) {
        const Edge& edge = edges_.at(key(a, b));
        take(a + share * (b - a), edge.normal, edge.facets == 1);
      }
      take(a, corners_.at(a), border_.contains(a));
    }
    return best;
  }

  std::vector<Facet> facets_;
  std::map<Vec, Vec> corners_;
  std::map<std::pair<Vec, Vec>, Edge> edges_;
  std::map<Vec, bool> border_;
  Vec low_{HUGE_VALL, HUGE_VALL, HUGE_VALL}, high_{-HUGE_VALL, -HUGE_VALL, -HUGE_VALL};
};

Face surface(const json& given, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / given.at("file").get<std::string>();
  const bool stl = !starts_with_dollar(file);
  const Facets facets(stl ? read_stl(file) : read_gmsh_facets(file, given.value("group", "")));
  return [facets](const Vec& x, const Vec& outer) { return facets.face(x, outer); };
}

}  // namespace

Face read_obstacle(const json& obstacle, const std::filesystem::path& folder) {
  const std::string kind = obstacle.items().begin().key();
  const json& given = obstacle.at(kind);
  // The gap is a difference between the distance to some point of the obstacle and some size of it.
  const auto measured = [](Face face, const Vec& about, Real size, Real share) -> Face {
    return [=](const Vec& x, const Vec& outer) {
      Facing found = face(x, outer);
      found.unknown = share * (norm(x - about) + size);
      return found;
    };
  };
  const auto at = [&](const char* key) { return read_vector(given.at(key)); };
  if (kind == "plane") return plane(given);
  if (kind == "sphere")
    return measured(round_thing(given, "centre", {}), at("centre"), number(given, "radius"), closed);
  if (kind == "cylinder")
    return measured(round_thing(given, "point", unit(wide_vector(given.at("axis")))), at("point"),
                    number(given, "radius"), closed);
  if (kind == "cone") return measured(cone(given), at("apex"), 0, with_sines);
  if (kind == "torus")
    return measured(torus(given), at("centre"), number(given, "radius") + number(given, "tube"), closed);
  if (kind == "box") return block(given);
  if (kind == "surface") return measured(surface(given, folder), {}, 0, in_double);
  if (kind == "height_map") return measured(read_height_map(given, folder), {}, 0, in_double);
  if (kind != "gap") throw Failure("obstacle: the verifier does not know \"" + kind + "\"");
  const Real gap = given.get<double>();
  return [gap](const Vec&, const Vec& outer) { return Facing{unit(outer), gap}; };
}

}  // namespace kacanov::verify
