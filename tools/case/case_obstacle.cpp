// SPDX-License-Identifier: BSD-3-Clause
// Parses the obstacle of a contact entry.
#include "case/case_obstacle.hpp"

#include <array>
#include <variant>

#include <kacanov/model.hpp>
#include "case/case_schema.hpp"
#include "case/case_words.hpp"

namespace kacanov {
namespace {

/// Arguments of the obstacle parsers.
struct Source {
  const ReadVector& vector;
  std::optional<ObstacleFile>& file;
  std::string path;  ///< path of the obstacle in the case

  Vector3 required(const Object& parts, const char* key) const { return vector(parts.required(key)); }
  std::optional<Vector3> direction(const Object& parts) const {
    const auto way = parts.optional("direction");
    return way ? std::optional(vector(*way)) : std::nullopt;
  }
  /// Reads a sphere or cylinder, which the body may touch from outside or from inside.
  template <class Round>
  void take_round(const Object& parts, Round& round) const {
    round.radius = parts.required("radius").number();
    round.direction = direction(parts);
    const auto inside = parts.optional("inside");
    round.inside = inside && inside->boolean();
  }
  /// Sets the file that the obstacle's geometry comes from.
  ObstacleFile& new_file(const Object& parts) const {
    ObstacleFile& made = file.emplace();
    made.path = path;
    made.name = parts.required("file").text();
    return made;
  }
};

Obstacle read_plane(const Object& parts, const Source& from) {
  return Plane{from.required(parts, "point"), from.required(parts, "normal")};
}

Obstacle read_sphere(const Object& parts, const Source& from) {
  Sphere result;
  result.centre = from.required(parts, "centre");
  from.take_round(parts, result);
  return result;
}

Obstacle read_cylinder(const Object& parts, const Source& from) {
  Cylinder result;
  result.point = from.required(parts, "point");
  result.axis = from.required(parts, "axis");
  from.take_round(parts, result);
  return result;
}

Obstacle read_cone(const Object& parts, const Source& from) {
  return Cone{from.required(parts, "apex"), from.required(parts, "axis"),
              parts.required("half_angle").number(), from.direction(parts)};
}

Obstacle read_torus(const Object& parts, const Source& from) {
  return Torus{from.required(parts, "centre"), from.required(parts, "axis"),
               parts.required("radius").number(), parts.required("tube").number()};
}

Obstacle read_box(const Object& parts, const Source& from) {
  Block result;
  result.lower = from.required(parts, "lower");
  result.upper = from.required(parts, "upper");
  if (const auto frame = parts.optional("frame")) result.frame = parse_axes(*frame, from.vector);
  return result;
}

Obstacle read_surface(const Object& parts, const Source& from) {
  ObstacleFile& file = from.new_file(parts);
  if (const auto group = parts.optional("group")) file.group = group->text();
  return SurfaceObstacle{};
}

Obstacle read_height_map(const Object& parts, const Source& from) {
  const auto corner = [&parts](const char* key) -> std::array<double, 2> {
    const std::vector<Node> entries = parts.required(key).entries();
    return {entries[0].number(), entries[1].number()};
  };
  ObstacleFile& file = from.new_file(parts);
  file.lower = corner("lower");
  file.upper = corner("upper");
  if (const auto scale = parts.optional("scale")) file.scale = scale->number();
  if (const auto offset = parts.optional("offset")) file.offset = offset->number();
  HeightMap result;
  if (const auto side = parts.optional("body")) result.body_above = value_of(*side, words::body_above);
  return result;
}

Key direction_key() {
  return may("direction", vector_schema(),
             "from the body towards the obstacle; left out, to its closest point");
}

Key axis_key(const char* help) { return must("axis", vector_schema(), help); }

Key radius_key() { return must("radius", Number{positive}, "a length"); }

Key inside_key(bool fallback) { return may("inside", Flag{}, "whether the body is within", fallback); }

/// Lower or upper corner in the x-y plane.
Schema plane_corner() {
  const char* expected = "a list of two numbers, x and y";
  return ListOf{Number{}, expected, 2, 2};
}

struct ObstacleEntry {
  const char* name;
  const char* help;
  KeySet (*keys)();
  Obstacle (*read)(const Object& parts, const Source& from);
};

constexpr ObstacleEntry obstacle_entries[] = {
    {"plane", "a half-space",
     [] {
       return KeySet{{must("point", vector_schema(), "of the plane"),
                      must("normal", vector_schema(), "to the side of the body")}};
     },
     read_plane},
    {"sphere", "a ball, or a socket",
     [] {
       return KeySet{{must("centre", vector_schema(), "its middle"), radius_key(), direction_key(),
                      inside_key(Sphere().inside)}};
     },
     read_sphere},
    {"cylinder", "a cylinder without ends, or a bore; in 2D a strip",
     [] {
       return KeySet{{must("point", vector_schema(), "of the axis"), axis_key("along the cylinder"),
                      radius_key(), direction_key(), inside_key(Cylinder().inside)}};
     },
     read_cylinder},
    {"cone", "a cone without base; in 2D a wedge",
     [] {
       return KeySet{{must("apex", vector_schema(), "its tip"), axis_key("from the apex into the cone"),
                      must("half_angle", Number{cone_angle}, "degrees between axis and mantle"),
                      direction_key()}};
     },
     read_cone},
    {"torus", "a ring",
     [] {
       return KeySet{{must("centre", vector_schema(), "its middle"), axis_key("across the ring"),
                      must("radius", Number{positive}, "of the circle in the middle of the tube"),
                      must("tube", Number{positive}, "radius of the tube")}};
     },
     read_torus},
    {"box", "a block, along the axes or turned",
     [] {
       return KeySet{{must("lower", vector_schema(), "its lower corner"),
                      must("upper", vector_schema(), "its upper corner"),
                      may("frame", axes_schema(),
                          "orthogonal axes that its edges are along; left out, the coordinates'")}};
     },
     read_box},
    {"surface", "the triangles of a file; 3D only",
     [] {
       return KeySet{{must("file", Text{}, "STL or Gmsh .msh"),
                      may("group", Text{}, "of a .msh: the physical group of facets; left out, all")}};
     },
     read_surface},
    {"height_map", "heights over a rectangle; 3D only",
     [] {
       const ObstacleFile standard;
       return KeySet{{must("file", Text{}, "CSV, PNG, PGM or PBM"),
                      must("lower", plane_corner(), "x and y of the corner"),
                      must("upper", plane_corner(), "x and y of the opposite corner"),
                      may("scale", Number{}, "height of the value 1", standard.scale),
                      may("offset", Number{}, "height of the value 0", standard.offset),
                      may("body", one_of(words::body_above), "on which side of the heights the body is",
                          word_of(HeightMap().body_above, words::body_above))}};
     },
     read_height_map},
};
constexpr const char* gap_key = "gap";
static_assert(std::size(obstacle_entries) + 1 == std::variant_size_v<Obstacle>, "and the gap");

}  // namespace

Schema obstacle_schema() {
  KeySet set;
  OneOf kinds;
  for (const ObstacleEntry& entry : obstacle_entries)
    set.keys.push_back(may(entry.name, entry.keys(), entry.help));
  set.keys.push_back(may(gap_key, Number{}, "a constant gap along the body's outer normal, a length"));
  for (const Key& key : set.keys) kinds.keys.push_back(key.name);
  set.one_of.push_back(std::move(kinds));
  return set;
}

std::array<Vector3, 3> parse_axes(const Node& node, const ReadVector& vector) {
  const std::vector<Node> list = node.entries();
  std::array<Vector3, 3> all{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  for (std::size_t a = 0; a < list.size(); ++a) all[a] = vector(list[a]);
  return all;
}

Obstacle parse_obstacle(const Node& node, const ReadVector& vector, std::optional<ObstacleFile>& file) {
  const Object object(node);
  for (const ObstacleEntry& entry : obstacle_entries)
    if (const auto parts = object.optional(entry.name))
      return entry.read(Object(*parts), Source{vector, file, parts->path()});
  return ConstantGap{object.required(gap_key).number()};
}

Motion parse_motion(const Node& node, const ReadVector& vector) {
  const Object parts(node);
  Motion motion;
  if (const auto centre = parts.optional("centre")) motion.centre = vector(*centre);
  for (const Node& point : parts.required("path").entries()) {
    const Object place(point);
    Motion::Pose pose;
    pose.time = place.required("time").number();
    if (const auto translation = place.optional("translation")) pose.translation = vector(*translation);
    if (const auto rotation = place.optional("rotation")) {
      // In 2D the rotation is one number, about z.
      if (rotation->value().is_number())
        pose.rotation[2] = rotation->number();
      else
        pose.rotation = vector(*rotation);
    }
    motion.path.push_back(pose);
  }
  return motion;
}

ForceControl parse_force_control(const Node& node, const ReadVector& vector) {
  const Object parts(node);
  return {parts.required("force").number(), vector(parts.required("direction"))};
}

}  // namespace kacanov
