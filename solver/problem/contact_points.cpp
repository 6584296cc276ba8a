// SPDX-License-Identifier: BSD-3-Clause
// Nodes against obstacles: one producer of constraint rows.
#include "problem/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include <kacanov/error.hpp>
#include "problem/integration.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Below this length a trace row cannot carry a contact force: its node is held in that direction.
constexpr double negligible_trace = 1e-8;

struct Facing {
  Vector3 normal{};  ///< unit, towards the obstacle
  double gap = 0.0;
};

Vector3 unit(const Vector3& v, const std::string& path) {
  const double length = norm(v);
  if (!(length > 0.0)) throw InputError(path + ": expected a vector that is not zero");
  return (1.0 / length) * v;
}

/// How an obstacle faces a node at x whose outer normal (of any length) is given; nothing where it is missed.
class Faces {
 public:
  Faces(const Mesh& mesh, const Obstacle& obstacle, std::string path)
      : mesh_(mesh), obstacle_(obstacle), path_(std::move(path) + ".obstacle") {
    if (const auto* plane = std::get_if<Plane>(&obstacle_))
      direction_ = -1.0 * unit(plane->normal, path_ + ".plane.normal");
    if (const auto* sphere = std::get_if<Sphere>(&obstacle_)) {
      if (!(sphere->radius > 0.0)) throw InputError(path_ + ".sphere.radius: expected a number > 0");
      if (sphere->direction) direction_ = unit(*sphere->direction, path_ + ".sphere.direction");
    }
  }

  std::optional<Facing> at(std::int32_t node, const Vector3& outer) const {
    const Vector3 x = position(mesh_, node);
    if (const auto* plane = std::get_if<Plane>(&obstacle_)) {
      return Facing{direction_, dot(plane->point - x, direction_)};
    }
    if (const auto* sphere = std::get_if<Sphere>(&obstacle_)) return at_sphere(*sphere, x, node);
    const double length = norm(outer);
    if (!(length > 0.0)) {
      throw InputError(path_ + ".gap: the outer normal at node " + std::to_string(mesh_.node_tag(node)) +
                       " is zero");
    }
    return Facing{(1.0 / length) * outer, std::get<ConstantGap>(obstacle_).gap};
  }

 private:
  std::optional<Facing> at_sphere(const Sphere& sphere, const Vector3& x, std::int32_t node) const {
    const Vector3 to_centre = sphere.centre - x;
    if (sphere.direction) {
      const double along = dot(to_centre, direction_);
      const double inside = sphere.radius * sphere.radius - (dot(to_centre, to_centre) - along * along);
      if (inside < 0.0) return std::nullopt;
      return Facing{direction_, along - std::sqrt(inside)};
    }
    const double distance = norm(to_centre);
    if (!(distance > 0.0)) {
      throw InputError(path_ + ".sphere: node " + std::to_string(mesh_.node_tag(node)) +
                       " lies at the centre, where no direction leads out; give a \"direction\"");
    }
    return Facing{(1.0 / distance) * to_centre, distance - sphere.radius};
  }

  const Mesh& mesh_;
  const Obstacle& obstacle_;
  std::string path_;
  Vector3 direction_{};
};

/// ν without what is held of it.
Vector3 free_components(const ContactPoint& point, const Problem& problem) {
  const std::size_t dim = problem.mesh.dim();
  Vector3 trace{};
  for (std::size_t c = 0; c < dim; ++c)
    if (problem.held[point.node * dim + c] == 0) trace[c] = point.normal[c];
  return trace;
}

/// Fills tangents from the normal and the free components, and takes from the gap what the prescribed ones
/// close. False where the node cannot move along the normal.
bool restrict_to_free(ContactPoint& point, const Problem& problem, bool friction) {
  const std::size_t dim = problem.mesh.dim();
  const std::size_t base = point.node * dim;
  std::array<bool, 3> free{};
  for (std::size_t c = 0; c < dim; ++c) {
    free[c] = problem.held[base + c] == 0;
    if (!free[c]) point.gap -= point.normal[c] * problem.prescribed[base + c];
  }
  const Vector3 trace = free_components(point, problem);
  const double length = norm(trace);
  if (length < negligible_trace) return false;
  if (!friction) return true;
  // Gram–Schmidt of the free axes against the trace and each other, the least aligned axis first.
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(trace[a]) < std::abs(trace[b]); });
  const Vector3 along = (1.0 / length) * trace;
  for (const std::size_t axis : axes) {
    if (!free[axis]) continue;
    Vector3 t{};
    t[axis] = 1.0;
    t = t - dot(t, along) * along;
    for (int k = 0; k < point.tangents; ++k) {
      const Vector3& other = point.tangent[k];
      t = t - dot(t, other) * other;
    }
    // The last free axis is spanned by the trace and the tangents so far.
    if (norm(t) < negligible_trace || point.tangents == 2) continue;
    point.tangent[point.tangents++] = (1.0 / norm(t)) * t;
  }
  return true;
}

/// Joins points of one node that face the same way at the same gap: masses add up, bounds are averaged by
/// mass. What was joined is in `shares`.
std::vector<ContactPoint> merge_equal(const std::vector<ContactPoint>& points, double size,
                                      std::vector<PointShare>& shares) {
  std::vector<ContactPoint> merged;
  for (const ContactPoint& point : points) {
    ContactPoint* twin = nullptr;
    for (std::size_t k = merged.size(); k-- > 0 && merged[k].node == point.node;) {
      if (norm(merged[k].normal - point.normal) < 1e-9 && std::abs(merged[k].gap - point.gap) < 1e-9 * size) {
        twin = &merged[k];
      }
    }
    if (twin == nullptr) {
      merged.push_back(point);
      continue;
    }
    const auto joined = static_cast<std::int32_t>(twin - merged.data());
    const auto of_node = [&](const PointShare& s) { return merged[s.point].node == point.node; };
    auto known = shares.rbegin();
    while (known != shares.rend() && of_node(*known) && known->point != joined) ++known;
    if (known == shares.rend() || known->point != joined) shares.push_back({joined, twin->entry, twin->mass});
    shares.push_back({joined, point.entry, point.mass});
    const double mass = twin->mass + point.mass;
    twin->tresca = (twin->mass * twin->tresca + point.mass * point.tresca) / mass;
    twin->coulomb = (twin->mass * twin->coulomb + point.mass * point.coulomb) / mass;
    if (twin->tangents == 0) {
      twin->tangents = point.tangents;
      twin->tangent = point.tangent;
      twin->since_step = point.since_step;
    }
    twin->mass = mass;
  }
  for (PointShare& share : shares) share.share /= merged[share.point].mass;
  std::stable_sort(shares.begin(), shares.end(),
                   [](const PointShare& a, const PointShare& b) { return a.point < b.point; });
  return merged;
}

/// Corners of quadratic facets are no contact points: says so where one stands out towards the obstacle, from
/// all mid-sides beside it, by this share of the way to them. Under a ball of radius R facets of 0.4 R do.
constexpr double stands_out = 0.1;

void warn_of_corners(Problem& problem, const Faces& faces, std::span<const std::int32_t> facets,
                     const std::string& path) {
  const Mesh& mesh = problem.mesh;
  const Cell& type = cell(mesh.type).facet();
  if (type.order == 1) return;
  struct Corner {
    double nearest = HUGE_VAL, length = 0.0;  ///< gap of the mid-sides beside it; the edge of that
    Vector3 outer{};
  };
  std::map<std::int32_t, Corner> corners;
  for (const std::int32_t f : facets) {
    const auto facet = mesh.facet(f);
    const FacetWeights weights = lumped_weights(mesh, f);
    for (const CellEdge& edge : type.edges)
      for (const std::int8_t end : {edge.a, edge.b}) {
        const std::int32_t middle = facet[edge.middle];
        Corner& corner = corners[facet[end]];
        corner.outer = corner.outer + weights.normal[edge.middle];
        const std::optional<Facing> facing = faces.at(middle, weights.normal[edge.middle]);
        if (!facing || facing->gap >= corner.nearest) continue;
        corner.nearest = facing->gap;
        corner.length = norm(position(mesh, middle) - position(mesh, facet[end]));
      }
  }
  for (const auto& [node, corner] : corners) {
    if (!(norm(corner.outer) > 0.0)) continue;
    const std::optional<Facing> facing = faces.at(node, corner.outer);
    if (!facing || !(corner.nearest - facing->gap > stands_out * corner.length)) continue;
    problem.warnings.push_back(
        path + ": node " + std::to_string(mesh.node_tag(node)) + " at " +
        to_text(position(mesh, node), mesh.dim()) +
        " is nearer to the obstacle than what is round it; it is a corner of quadratic facets, whose contact "
        "nodes are the mid-sides, and may go through: take smaller facets there");
    return;
  }
}

std::vector<ContactPoint> points_of_entry(const Problem& problem, const ContactEntry& entry,
                                          std::size_t index, std::span<const std::int32_t> facets,
                                          const std::string& path) {
  const Mesh& mesh = problem.mesh;
  const Faces faces(mesh, entry.obstacle, path);
  const bool friction = entry.friction && (entry.friction->tresca > 0.0 || entry.friction->coulomb > 0.0);
  const std::vector<std::int32_t> nodes = nodes_of_facets(mesh, facets);
  std::vector<double> mass(nodes.size());
  std::vector<Vector3> outer(nodes.size());
  for (const std::int32_t f : facets) {
    const FacetWeights weights = lumped_weights(mesh, f);
    const auto facet = mesh.facet(f);
    for (std::size_t k = 0; k < facet.size(); ++k) {
      const auto place =
          static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), facet[k]) - nodes.begin());
      mass[place] += weights.area[k];
      outer[place] = outer[place] + weights.normal[k];
    }
  }
  std::vector<ContactPoint> points;
  std::size_t candidates = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!(mass[k] > 0.0)) continue;  // corners of quadratic facets bear nothing
    ++candidates;
    const std::optional<Facing> facing = faces.at(nodes[k], outer[k]);
    if (!facing) continue;
    ContactPoint point;
    point.node = nodes[k];
    point.entry = static_cast<std::int32_t>(index);
    point.normal = facing->normal;
    point.gap = facing->gap;
    point.mass = mass[k];
    if (friction) {
      point.tresca = entry.friction->tresca;
      point.coulomb = entry.friction->coulomb;
      point.since_step = entry.friction->reference == Friction::Reference::step;
    }
    if (restrict_to_free(point, problem, friction)) points.push_back(point);
  }
  if (points.empty()) {
    throw InputError(path + ": none of the " + std::to_string(candidates) +
                     " nodes can touch the obstacle: each is held by a displacement or misses it");
  }
  return points;
}

}  // namespace

void find_contact_points(Problem& problem, const Model& model, const Selection& selection) {
  std::vector<std::int32_t> entry_of_facet(problem.mesh.facet_count(), -1);
  std::vector<ContactPoint> points;
  for (std::size_t i = 0; i < model.contact.size(); ++i) {
    const std::string path = "contact[" + std::to_string(i) + "]";
    const std::vector<std::int32_t> facets = selection.facets(model.contact[i].on, path);
    for (const std::int32_t f : facets) {
      std::int32_t& owner = entry_of_facet[f];
      if (owner >= 0) {
        const std::size_t element = problem.mesh.facet_element[f];
        throw InputError(path + ".on: the facet of element " +
                         std::to_string(problem.mesh.element_tag(element)) + " already belongs to contact[" +
                         std::to_string(owner) + "]");
      }
      owner = static_cast<std::int32_t>(i);
    }
    const std::vector<ContactPoint> more = points_of_entry(problem, model.contact[i], i, facets, path);
    warn_of_corners(problem, Faces(problem.mesh, model.contact[i].obstacle, path), facets, path);
    points.insert(points.end(), more.begin(), more.end());
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const ContactPoint& a, const ContactPoint& b) { return a.node < b.node; });
  for (const ContactPoint& point : merge_equal(points, extent(problem.mesh).size, problem.contact_shares)) {
    const RowEntry entry{point.node, point.normal, free_components(point, problem), point.tangent};
    problem.contact.push_back(point, {&entry, 1});
  }
}

}  // namespace kacanov
