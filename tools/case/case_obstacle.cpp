// SPDX-License-Identifier: BSD-3-Clause
// The obstacle of a contact entry.
#include "case/case_obstacle.hpp"

#include <kacanov/rules.hpp>

namespace kacanov {
namespace {

class ObstacleParser {
 public:
  ObstacleParser(const ReadVector& vector, std::optional<ObstacleFile>& file)
      : vector_(vector), file_(file) {}

  Plane plane(const Node& node) const {
    const Object parts(node, {"point", "normal"});
    return {vector_(parts.required("point")), vector_(parts.required("normal"))};
  }
  Sphere sphere(const Node& node) const {
    const Object parts(node, {"centre", "radius", "direction", "inside"});
    Sphere result;
    result.centre = vector_(parts.required("centre"));
    take_round(parts, result);
    return result;
  }
  Cylinder cylinder(const Node& node) const {
    const Object parts(node, {"point", "axis", "radius", "direction", "inside"});
    Cylinder result;
    result.point = vector_(parts.required("point"));
    result.axis = vector_(parts.required("axis"));
    take_round(parts, result);
    return result;
  }
  Cone cone(const Node& node) const {
    const Object parts(node, {"apex", "axis", "half_angle", "direction"});
    return {vector_(parts.required("apex")), vector_(parts.required("axis")),
            parts.required("half_angle").number(), direction(parts)};
  }
  Torus torus(const Node& node) const {
    const Object parts(node, {"centre", "axis", "radius", "tube"});
    return {vector_(parts.required("centre")), vector_(parts.required("axis")),
            parts.required("radius").number(positive), parts.required("tube").number(positive)};
  }
  Block box(const Node& node) const {
    const Object parts(node, {"lower", "upper"});
    return {vector_(parts.required("lower")), vector_(parts.required("upper"))};
  }
  SurfaceObstacle surface(const Node& node) const {
    const Object parts(node, {"file", "group"});
    ObstacleFile& file = new_file(node, parts);
    if (const auto group = parts.optional("group")) file.group = group->text();
    return {};
  }
  HeightMap height_map(const Node& node) const {
    const Object parts(node, {"file", "lower", "upper", "scale", "offset", "body"});
    ObstacleFile& file = new_file(node, parts);
    file.lower = corner(parts.required("lower"));
    file.upper = corner(parts.required("upper"));
    if (const auto scale = parts.optional("scale")) file.scale = scale->number();
    if (const auto offset = parts.optional("offset")) file.offset = offset->number();
    HeightMap result;
    if (const auto side = parts.optional("body")) result.body_above = side->choice({"above", "below"}) == 0;
    return result;
  }

 private:
  std::optional<Vector3> direction(const Object& parts) const {
    const auto way = parts.optional("direction");
    return way ? std::optional(vector_(*way)) : std::nullopt;
  }
  /// Of what a body may touch from outside or inside.
  template <class Round>
  void take_round(const Object& parts, Round& round) const {
    round.radius = parts.required("radius").number(positive);
    round.direction = direction(parts);
    const auto inside = parts.optional("inside");
    round.inside = inside && inside->boolean();
  }
  /// The file that an obstacle's data come from.
  ObstacleFile& new_file(const Node& node, const Object& parts) const {
    ObstacleFile& file = file_.emplace();
    file.path = node.path();
    file.name = parts.required("file").text();
    return file;
  }
  static std::array<double, 2> corner(const Node& node) {
    const std::vector<Node> entries = node.list("a list of two numbers, x and y");
    if (entries.size() != 2) node.expected("a list of two numbers, x and y");
    return {entries[0].number(), entries[1].number()};
  }

  const ReadVector& vector_;
  std::optional<ObstacleFile>& file_;
};

}  // namespace

Obstacle parse_obstacle(const Node& node, const ReadVector& vector, std::optional<ObstacleFile>& file) {
  const auto keys = {"plane", "sphere", "cylinder", "cone", "torus", "box", "surface", "height_map", "gap"};
  const Object object(node, keys);
  const std::string kind = object.only_one_of(keys);
  const Node value = object.required(kind);
  const ObstacleParser parser(vector, file);
  if (kind == "plane") return parser.plane(value);
  if (kind == "sphere") return parser.sphere(value);
  if (kind == "cylinder") return parser.cylinder(value);
  if (kind == "cone") return parser.cone(value);
  if (kind == "torus") return parser.torus(value);
  if (kind == "box") return parser.box(value);
  if (kind == "surface") return parser.surface(value);
  if (kind == "height_map") return parser.height_map(value);
  return ConstantGap{value.number()};
}

Motion parse_motion(const Node& node, const ReadVector& vector) {
  const Object parts(node, {"path", "centre"});
  Motion motion;
  if (const auto centre = parts.optional("centre")) motion.centre = vector(*centre);
  for (const Node& point : parts.required("path").list("a list of places and their times")) {
    const Object place(point, {"time", "translation", "rotation"});
    Motion::Pose pose;
    pose.time = place.required("time").number(positive);
    if (const auto translation = place.optional("translation")) pose.translation = vector(*translation);
    if (const auto rotation = place.optional("rotation")) {
      // In the plane a turn is a number: its axis is z.
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
  const Object parts(node, {"force", "direction"});
  return {parts.required("force").number(positive), vector(parts.required("direction"))};
}

}  // namespace kacanov
