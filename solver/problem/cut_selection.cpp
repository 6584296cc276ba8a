// SPDX-License-Identifier: BSD-3-Clause
// Warns if the box of an `on` cuts through facets or elements, since a box selects whole ones only.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <span>

#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "problem/warnings.hpp"

namespace kacanov::validity {
namespace {

/// Share of a facet or element in the box below which the cut is due to rounding.
constexpr double cut_share = 1e-3;
/// Cosine of the angle between facets of one smooth face: a box that selects a face may cut facets beyond the
/// body's edge without a warning.
constexpr double smooth = 0.75;

/// A segment, triangle or tetrahedron.
struct Simplex {
  std::size_t corners = 0;
  std::array<Vector3, 4> x{};

  double measure(bool axisymmetric) const {
    double size = norm(x[1] - x[0]);
    if (corners == 3) size = 0.5 * norm(cross(x[1] - x[0], x[2] - x[0]));
    if (corners == 4) size = std::abs(dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]))) / 6.0;
    if (!axisymmetric) return size;
    double radius = 0.0;
    for (std::size_t k = 0; k < corners; ++k) radius += x[k][0] / static_cast<double>(corners);
    return 2.0 * std::numbers::pi * radius * size;
  }
};

class ClippingBox {
 public:
  ClippingBox(const Selector& on, const Mesh& mesh, double slack)
      : dim_(static_cast<std::size_t>(mesh.dim())), axisymmetric_(mesh.plane == PlaneState::axisymmetric) {
    for (std::size_t c = 0; c < dim_; ++c) {
      lower_[c] = on.lower[c] - slack;
      upper_[c] = on.upper[c] + slack;
    }
  }

  /// Whether all points lie beyond one side of the box.
  bool misses(std::span<const Vector3> points) const {
    for (std::size_t c = 0; c < dim_; ++c)
      if (std::all_of(points.begin(), points.end(), [&](const Vector3& x) { return x[c] <= lower_[c]; }) ||
          std::all_of(points.begin(), points.end(), [&](const Vector3& x) { return x[c] >= upper_[c]; }))
        return true;
    return false;
  }
  double whole(const Simplex& simplex) const { return simplex.measure(axisymmetric_); }
  double inside(const Simplex& simplex) const { return inside(simplex, 0); }

 private:
  /// Measure of the part of a simplex inside all sides from number `side` on, of 2 dim sides.
  double inside(const Simplex& simplex, std::size_t side) const {
    if (side == 2 * dim_) return simplex.measure(axisymmetric_);
    const std::size_t c = side / 2;
    std::array<double, 4> beyond{};
    for (std::size_t k = 0; k < simplex.corners; ++k)
      beyond[k] = side % 2 == 0 ? lower_[c] - simplex.x[k][c] : simplex.x[k][c] - upper_[c];
    return divided(simplex, beyond, side);
  }
  /// Bisects the simplex at edges that cross the plane until no part crosses it.
  double divided(const Simplex& simplex, const std::array<double, 4>& beyond, std::size_t side) const {
    const auto end = beyond.begin() + static_cast<std::ptrdiff_t>(simplex.corners);
    const auto in = std::find_if(beyond.begin(), end, [](double d) { return d < 0.0; });
    const auto out = std::find_if(beyond.begin(), end, [](double d) { return d > 0.0; });
    if (out == end) return inside(simplex, side + 1);
    if (in == end) return 0.0;
    const auto i = static_cast<std::size_t>(in - beyond.begin()),
               o = static_cast<std::size_t>(out - beyond.begin());
    const Vector3 middle = simplex.x[i] + (*in / (*in - *out)) * (simplex.x[o] - simplex.x[i]);
    double sum = 0.0;
    for (const std::size_t moved : {i, o}) {
      Simplex part = simplex;
      std::array<double, 4> distances = beyond;
      part.x[moved] = middle;
      distances[moved] = 0.0;
      sum += divided(part, distances, side);
    }
    return sum;
  }

  std::size_t dim_;
  bool axisymmetric_;
  Vector3 lower_{}, upper_{};
};

/// Facets or elements of a mesh as simplices; curved ones are divided at their nodes.
class Cells {
 public:
  Cells(const Mesh& mesh, bool elements)
      : mesh_(mesh),
        type_(elements ? kacanov::cell(mesh.type) : kacanov::cell(mesh.type).facet()),
        nodes_(elements ? std::span(mesh.elements) : std::span(mesh.facets)) {}

  std::size_t size() const { return nodes_.size() / static_cast<std::size_t>(type_.nodes); }
  std::span<const std::int32_t> nodes(std::size_t i) const {
    const std::size_t n = type_.nodes;
    return nodes_.subspan(i * n, n);
  }
  int dim() const { return type_.dim; }
  std::vector<Vector3> points(std::size_t i) const {
    std::vector<Vector3> points;
    for (const std::int32_t node : nodes(i)) points.push_back(position(mesh_, node));
    return points;
  }
  template <class Measure>
  double sum(std::size_t i, const Measure& measure) const {
    const std::vector<Vector3> x = points(i);
    double sum = 0.0;
    if (type_.dim == 1) return measure(Simplex{2, {x[0], x[1]}});
    if (type_.dim == 2) {
      for (const auto& t : type_.triangles) sum += measure(Simplex{3, {x[t[0]], x[t[1]], x[t[2]]}});
      return sum;
    }
    if (type_.simplex) return measure(Simplex{4, {x[0], x[1], x[2], x[3]}});
    // Tetrahedra around the diagonal of a hexahedron.
    constexpr std::array<std::size_t, 7> ring{1, 2, 3, 7, 4, 5, 1};
    for (std::size_t k = 0; k < 6; ++k) sum += measure(Simplex{4, {x[0], x[ring[k]], x[ring[k + 1]], x[6]}});
    return sum;
  }

 private:
  const Mesh& mesh_;
  const Cell& type_;
  std::span<const std::int32_t> nodes_;
};

Vector3 unit_normal(const Mesh& mesh, std::size_t facet) {
  Vector3 sum{};
  for (const Vector3& part : consistent_weights(mesh, facet).normal) sum = sum + part;
  return norm(sum) > 0.0 ? (1.0 / norm(sum)) * sum : sum;
}

/// Returns those of the facets `cut` that continue the selected ones without a sharp edge in between.
std::vector<std::size_t> continued(const Mesh& mesh, const std::vector<std::size_t>& cut,
                                   std::span<const std::int32_t> selected) {
  // At nodes of cut facets: normals of the selected facets there.
  std::map<std::int32_t, std::vector<Vector3>> normals;
  for (const std::size_t f : cut)
    for (const std::int32_t node : mesh.facet(f)) normals[node];
  const auto add = [&](std::size_t f) {
    const Vector3 normal = unit_normal(mesh, f);
    for (const std::int32_t node : mesh.facet(f))
      if (const auto there = normals.find(node); there != normals.end()) there->second.push_back(normal);
  };
  for (const std::int32_t f : selected) {
    const auto facet = mesh.facet(f);
    if (std::any_of(facet.begin(), facet.end(), [&](std::int32_t node) { return normals.contains(node); }))
      add(static_cast<std::size_t>(f));
  }
  std::vector<std::size_t> found, left = cut;
  for (bool grown = true; grown;) {
    std::vector<std::size_t> more;
    for (const std::size_t f : left) {
      const Vector3 normal = unit_normal(mesh, f);
      const auto facet = mesh.facet(f);
      if (std::any_of(facet.begin(), facet.end(), [&](std::int32_t node) {
            const std::vector<Vector3>& there = normals[node];
            return std::any_of(there.begin(), there.end(),
                               [&](const Vector3& other) { return dot(other, normal) > smooth; });
          }))
        more.push_back(f);
    }
    grown = !more.empty();
    for (const std::size_t f : more) add(f);
    found.insert(found.end(), more.begin(), more.end());
    std::vector<std::size_t> rest;
    std::set_difference(left.begin(), left.end(), more.begin(), more.end(), std::back_inserter(rest));
    left = rest;
  }
  return found;
}

/// Formats two numbers with as many digits as needed to distinguish them.
std::array<std::string, 2> told_apart(double a, double b) {
  for (int digits = 3; digits < 17; ++digits) {
    const std::array<std::string, 2> text{rounded(a, digits), rounded(b, digits)};
    if (text[0] != text[1] || digits == 16) return text;
  }
  return {};
}

void check_box(const Mesh& mesh, const Selector& on, const std::string& path, bool elements,
               Warnings& warnings) {
  if (on.kind != Selector::Kind::box) return;
  const Selection selection(mesh);
  const std::vector<std::int32_t> selected =
      elements ? selection.elements(on, path) : selection.facets(on, path);
  const Cells cells(mesh, elements);
  const ClippingBox box(on, mesh, 1e-9 * extent(mesh).size);
  const auto inside = [&](std::size_t i) {
    return cells.sum(i, [&](const Simplex& simplex) { return box.inside(simplex); });
  };
  const auto whole = [&](std::size_t i) {
    return cells.sum(i, [&](const Simplex& simplex) { return box.whole(simplex); });
  };
  std::vector<std::size_t> cut;
  auto next = selected.begin();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (next != selected.end() && static_cast<std::size_t>(*next) == i) {
      ++next;
      continue;
    }
    if (!box.misses(cells.points(i)) && inside(i) > cut_share * whole(i)) cut.push_back(i);
  }
  if (!elements && !cut.empty()) cut = continued(mesh, cut, selected);
  if (cut.empty()) return;
  double taken = 0.0, within = 0.0;
  for (const std::int32_t i : selected) taken += whole(static_cast<std::size_t>(i));
  for (const std::size_t i : cut) within += inside(i);
  const auto [taken_text, within_text] = told_apart(taken, taken + within);
  const char* measure = cells.dim() == 3 ? "volume" : "area";
  if (cells.dim() == 1 && mesh.plane != PlaneState::axisymmetric) measure = "length";
  const std::string kind = elements ? "element" : "facet";
  warnings.push_back(path + ".on: the box cuts through " + std::to_string(cut.size()) + " " + kind +
                     (cut.size() == 1 ? "" : "s") + ", and only whole ones are taken: the " +
                     std::to_string(selected.size()) + " taken have the " + measure + " " + taken_text +
                     ", what lies in the box has " + within_text + "; let the box end at sides of " + kind +
                     "s, or name a part of the mesh");
}

}  // namespace

void cut_selections(const Problem& problem, const Model& model, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    check_box(mesh, model.materials[i].on, "material[" + std::to_string(i) + "]", true, warnings);
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    check_box(mesh, entry.on, entry_name(entry, i), entry.body_force || entry.temperature, warnings);
  }
  for (std::size_t i = 0; i < model.contact.size(); ++i)
    check_box(mesh, model.contact[i].on, entry_name(model.contact[i], i), false, warnings);
}

}  // namespace kacanov::validity
