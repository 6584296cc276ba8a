// SPDX-License-Identifier: BSD-3-Clause
// Generates constraint rows for nodes against obstacles.
#include "problem/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "problem/faces.hpp"
#include "problem/integration.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// In body sizes: gap of a node that currently misses an obstacle which may come into its way.
constexpr double far_away = 10.0;

/// A shorter trace row cannot carry a contact force: its node is constrained in that direction.
constexpr double negligible_trace = 1e-8;

/// Formats a value with three digits.
std::string rough(double value) {
  PlainText text;
  text.precision(3);
  text << value;
  return text.str();
}

/// Throws if the error bound of a gap exceeds the size of the body.
void refuse_unknown(const Facing& facing, double size, std::int64_t node_tag, const std::string& path) {
  if (facing.unknown < size) return;
  throw InputError(path + ": expected an obstacle not so large or so far away that the gap of node " +
                   std::to_string(node_tag) + " is known to ±" + rough(facing.unknown) +
                   " only, where the size of the body is " + rough(size));
}

/// Relative to the body's size: displacement of the obstacle by input rounding that causes no warning.
constexpr double read_to = 1e-9;

/// Warns if double precision, in which the case's lengths are read, is coarse relative to the body.
void warn_of_reading(Problem& problem, double lengths, const std::string& path) {
  const double moved = 0x1p-53 * lengths, size = extent(problem.mesh).size;
  if (!(moved > read_to * size)) return;
  problem.warnings.push_back(
      path +
      ": the obstacle is so large or so far away that its numbers, as double precision reads them, "
      "place it to " +
      rough(moved) + " only, where the size of the body is " + rough(size) +
      ": gaps are those of the numbers as they are read");
}

NodeFreedom freedom_of(const Problem& problem, std::int32_t node) {
  const std::size_t dim = problem.mesh.dim();
  NodeFreedom freedom;
  for (std::size_t c = 0; c < dim; ++c) freedom.free[c] = problem.held[node * dim + c] == 0;
  freedom.held = directions_of(problem.directions, node);
  return freedom;
}

/// Returns the closure of the gap by prescribed components of the point's node.
double closed_by_prescription(const ContactPoint& point, const Problem& problem) {
  const std::size_t dim = problem.mesh.dim();
  double closed = 0.0;
  for (std::size_t c = 0; c < dim; ++c)
    if (problem.held[point.node * dim + c] != 0)
      closed += point.normal[c] * problem.prescribed[point.node * dim + c];
  for (const HeldDirection& held : directions_of(problem.directions, point.node))
    closed += dot(point.normal, held.direction) * held.value;
  return closed;
}

bool different_reference(const ContactPoint& a, const ContactPoint& b) {
  return a.tangents > 0 && b.tangents > 0 && a.since_step != b.since_step;
}

/// Merges points of one node with the same direction and gap: masses are added, bounds averaged by mass; the
/// smaller gap is used, and the difference is added to its error bound. `shares` records merged points.
/// Points of moving obstacles, and those whose slip has different reference times, are not merged.
std::vector<ContactPoint> merge_equal(const std::vector<ContactPoint>& points, const Model& model,
                                      double size, std::vector<PointShare>& shares) {
  std::vector<ContactPoint> merged;
  for (const ContactPoint& point : points) {
    ContactPoint* twin = nullptr;
    const auto moves = [&](const ContactPoint& p) { return model.contact[p.entry].moves(); };
    for (std::size_t k = merged.size(); k-- > 0 && merged[k].node == point.node;) {
      if (moves(point) || moves(merged[k]) || different_reference(point, merged[k])) continue;
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
    twin->unknown_gap = std::max(twin->unknown_gap, point.unknown_gap) + std::abs(twin->gap - point.gap);
    twin->gap = std::min(twin->gap, point.gap);
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

/// Corners of quadratic facets are no contact points. Warns if one protrudes towards the obstacle beyond all
/// adjacent mid-side nodes by this share of their distance, as with facets of 0.4 R under a ball of radius R.
constexpr double stands_out = 0.1;

void warn_of_corners(Problem& problem, const Faces& faces, std::span<const std::int32_t> facets,
                     const std::string& path) {
  const Mesh& mesh = problem.mesh;
  const Cell& type = cell(mesh.type).facet();
  if (type.order == 1) return;
  struct Corner {
    /// Smallest gap of the adjacent mid-side nodes, and the distance to that node.
    double nearest = HUGE_VAL, length = 0.0;
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

/// Warns about nodes at which the rule for equally near faces decides (theory: equal-distance).
void warn_of_choices(Problem& problem, std::span<const std::int32_t> nodes, const std::string& path) {
  if (nodes.empty()) return;
  const Mesh& mesh = problem.mesh;
  const std::string count = std::to_string(nodes.size());
  problem.warnings.push_back(
      path + ": " + count + (nodes.size() == 1 ? " node is" : " nodes are") +
      " equally near to several faces of the obstacle, the first node " +
      std::to_string(mesh.node_tag(static_cast<std::size_t>(nodes[0]))) + " at " +
      to_text(position(mesh, nodes[0]), mesh.dim()) +
      ": contact there is along the normal that opposes the body's most, or the mean of those that do so "
      "equally; give the obstacle a rounded edge, or move it, if another face is meant");
}

std::vector<ContactPoint> points_of_entry(Problem& problem, const ContactEntry& entry, std::size_t index,
                                          std::span<const std::int32_t> facets, const std::string& path) {
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
  std::vector<std::int32_t> chosen;
  std::size_t candidates = 0;
  double lengths = 0.0;
  const double size = extent(mesh).size;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!(mass[k] > 0.0)) continue;  // corners of quadratic facets carry no force
    ++candidates;
    std::optional<Facing> facing = faces.at(nodes[k], outer[k]);
    // A node that misses the obstacle now may meet it later.
    if (!facing && entry.relinearise && norm(outer[k]) > 0.0)
      facing = Facing{(1.0 / norm(outer[k])) * outer[k], far_away * size};
    if (!facing) continue;
    refuse_unknown(*facing, size, mesh.node_tag(nodes[k]), faces.path());
    lengths = std::max(lengths, facing->lengths);
    ContactPoint point;
    point.node = nodes[k];
    point.entry = static_cast<std::int32_t>(index);
    point.normal = facing->normal;
    point.outer = outer[k];
    point.gap = facing->gap;
    point.unknown_gap = facing->unknown;
    point.mass = mass[k];
    if (friction) {
      point.tresca = entry.friction->tresca;
      point.coulomb = entry.friction->coulomb;
      point.since_step = entry.friction->reference == Friction::Reference::step;
    }
    if (!narrow_row(point, freedom_of(problem, point.node), friction)) continue;
    point.gap -= closed_by_prescription(point, problem);
    points.push_back(point);
    if (facing->chosen) chosen.push_back(nodes[k]);
  }
  if (points.empty()) {
    throw InputError(path + ": none of the " + std::to_string(candidates) +
                     " nodes can touch the obstacle: each is held by a displacement or misses it");
  }
  warn_of_reading(problem, lengths, faces.path());
  warn_of_choices(problem, chosen, faces.path());
  return points;
}

}  // namespace

std::optional<RowEntry> narrow_row(ContactPoint& point, const NodeFreedom& freedom, bool friction) {
  const Vector3 trace = freedom.project(point.normal);
  const double length = norm(trace);
  if (length < negligible_trace) return std::nullopt;
  point.tangents = 0;
  point.tangent = {};
  // Gram–Schmidt on the free axes against the trace and each other, least aligned axis first.
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(trace[a]) < std::abs(trace[b]); });
  const Vector3 along = (1.0 / length) * trace;
  for (const std::size_t axis : axes) {
    if (!friction || !freedom.free[axis]) continue;
    Vector3 t{};
    t[axis] = 1.0;
    t = freedom.project(t);
    t = t - dot(t, along) * along;
    for (int k = 0; k < point.tangents; ++k) {
      const Vector3& other = point.tangent[k];
      t = t - dot(t, other) * other;
    }
    // The last free axis depends on the trace and the tangents found so far.
    if (norm(t) < negligible_trace || point.tangents == 2) continue;
    point.tangent[point.tangents++] = (1.0 / norm(t)) * t;
  }
  return RowEntry{point.node, point.normal, trace, point.tangent};
}

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
  for (const ContactPoint& point :
       merge_equal(points, model, extent(problem.mesh).size, problem.contact_shares)) {
    const Vector3 trace = freedom_of(problem, point.node).project(point.normal);
    const RowEntry entry{point.node, point.normal, trace, point.tangent};
    problem.contact.push_back(point, {&entry, 1});
  }
}

}  // namespace kacanov
