// SPDX-License-Identifier: BSD-3-Clause
// A triangulated surface with a bounding-box tree for closest points (theory: surface-distance).
#include <kacanov/surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <kacanov/error.hpp>
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

constexpr std::int32_t leaf_size = 4;
/// Merging distance relative to the extent: the resolution of single-precision files.
constexpr double joined = 1e-7;

/// Products of four larger lengths overflow.
constexpr double largest_coordinate = 1e70;

/// Returns 0 if `whole` has underflowed.
double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// Long double differences: in double precision the rounding of coordinates hides the direction to close
/// points.
using Wide = std::array<long double, 3>;
Wide difference(const Vector3& a, const Vector3& b) {
  return {static_cast<long double>(a[0]) - b[0], static_cast<long double>(a[1]) - b[1],
          static_cast<long double>(a[2]) - b[2]};
}
long double wide_dot(const Wide& a, const Wide& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Wide wide_cross(const Wide& a, const Wide& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Returns a + share · b, rounded to double.
Vector3 rounded_sum(const Wide& a, long double share, const Wide& b) {
  Vector3 sum;
  for (std::size_t c = 0; c < 3; ++c) sum[c] = static_cast<double>(a[c] + share * b[c]);
  return sum;
}

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// Numbers points and merges each one with an earlier one within `reach`.
class PointIndex {
 public:
  PointIndex(std::vector<Vector3>& points, double reach)
      : points_(points), reach_(reach), cell_(1024 * reach) {}

  std::int32_t find(const Vector3& x) {
    // Cells are so large that hardly any point is near a neighbouring cell.
    std::array<std::int64_t, 3> low{}, high{}, key{};
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::llround(std::floor((x[c] - reach_) / cell_));
      high[c] = std::llround(std::floor((x[c] + reach_) / cell_));
      key[c] = std::llround(std::floor(x[c] / cell_));
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto cell = cells_.find({i, j, k});
          if (cell == cells_.end()) continue;
          for (const std::int32_t point : cell->second)
            if (norm(points_[point] - x) <= reach_) return point;
        }
    const auto number = static_cast<std::int32_t>(points_.size());
    points_.push_back(x);
    cells_[key].push_back(number);
    return number;
  }

 private:
  std::vector<Vector3>& points_;
  double reach_, cell_;
  std::map<std::array<std::int64_t, 3>, std::vector<std::int32_t>> cells_;
};

/// Normalises a sum of unit vectors; returns zero if they cancel.
Vector3 mean_direction(const Vector3& sum) {
  const double length = norm(sum);
  return length > 1e-9 ? (1.0 / length) * sum : Vector3{};
}

}  // namespace

double Surface::Box::squared_distance(const Vector3& x) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double beyond = std::max({lower[c] - x[c], 0.0, x[c] - upper[c]});
    sum += beyond * beyond;
  }
  return sum;
}

Surface::Surface(const std::vector<Vector3>& points, const std::vector<Triangle>& triangles) {
  if (triangles.size() > std::numeric_limits<std::int32_t>::max() / 3)
    throw InputError("expected fewer than 715827882 triangles");
  join_points(points, triangles);
  if (faces_.empty()) throw InputError("expected at least one triangle that has an area");
  find_normals();
  tree_.reserve(faces_.size());
  build(0, static_cast<std::int32_t>(faces_.size()));
}

void Surface::join_points(const std::vector<Vector3>& points, const std::vector<Triangle>& triangles) {
  Vector3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::int32_t from : triangles[t]) {
      const std::string name = "triangle " + std::to_string(t);
      if (from < 0 || static_cast<std::size_t>(from) >= points.size())
        throw InputError(name + ": point " + std::to_string(from) + " is not there");
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = points[from][c];
        if (!(std::abs(x) <= largest_coordinate))
          throw InputError(name + ": expected coordinates of at most 1e70");
        low[c] = std::min(low[c], x);
        high[c] = std::max(high[c], x);
      }
    }
  extent_ = norm(high - low);
  if (!(extent_ > 0.0)) return;
  PointIndex index(points_, joined * extent_);
  for (const Triangle& triangle : triangles) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) face.corner[k] = index.find(points[triangle[k]] - low);
    const Vector3& a = points_[face.corner[0]];
    const Vector3 normal = cross(points_[face.corner[1]] - a, points_[face.corner[2]] - a);
    const double area = norm(normal);
    if (!(area > 0.0)) continue;
    face.normal = (1.0 / area) * normal;
    faces_.push_back(face);
  }
  for (Vector3& x : points_) x = x + low;
}

void Surface::find_normals() {
  struct Edge {
    Vector3 sum{};
    int faces = 0;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Edge> edges;
  const auto edge_of = [](const Face& face, std::size_t k) {
    const std::int32_t a = face.corner[k], b = face.corner[(k + 1) % 3];
    return std::pair{std::min(a, b), std::max(a, b)};
  };
  corner_normals_.assign(points_.size(), Vector3{});
  border_points_.assign(points_.size(), 0);
  for (const Face& face : faces_)
    for (std::size_t k = 0; k < 3; ++k) {
      Edge& edge = edges[edge_of(face, k)];
      edge.sum = edge.sum + face.normal;
      ++edge.faces;
      const Vector3& x = points_[face.corner[k]];
      const double angle =
          angle_between(points_[face.corner[(k + 1) % 3]] - x, points_[face.corner[(k + 2) % 3]] - x);
      Vector3& corner = corner_normals_[face.corner[k]];
      corner = corner + angle * face.normal;
    }
  for (Vector3& normal : corner_normals_) normal = mean_direction(normal);
  for (Face& face : faces_)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto ends = edge_of(face, k);
      const Edge& edge = edges[ends];
      face.edge[k] = mean_direction(edge.sum);
      face.border[k] = edge.faces == 1;
      if (face.border[k]) border_points_[ends.first] = border_points_[ends.second] = 1;
    }
}

std::int32_t Surface::build(std::int32_t first, std::int32_t last) {
  const auto centre = [&](const Face& f, std::size_t c) {
    return points_[f.corner[0]][c] + points_[f.corner[1]][c] + points_[f.corner[2]][c];
  };
  TreeNode node{{points_[faces_[first].corner[0]], points_[faces_[first].corner[0]]}, first, last, -1};
  Vector3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (std::int32_t f = first; f < last; ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      for (const std::int32_t corner : faces_[f].corner) {
        node.box.lower[c] = std::min(node.box.lower[c], points_[corner][c]);
        node.box.upper[c] = std::max(node.box.upper[c], points_[corner][c]);
      }
      low[c] = std::min(low[c], centre(faces_[f], c));
      high[c] = std::max(high[c], centre(faces_[f], c));
    }
  const auto place = static_cast<std::int32_t>(tree_.size());
  tree_.push_back(node);
  if (last - first <= leaf_size) return place;
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (high[c] - low[c] > high[axis] - low[axis]) axis = c;
  const std::int32_t middle = first + (last - first) / 2;
  std::nth_element(faces_.begin() + first, faces_.begin() + middle, faces_.begin() + last,
                   [&](const Face& a, const Face& b) { return centre(a, axis) < centre(b, axis); });
  build(first, middle);
  const std::int32_t second = build(middle, last);
  tree_[place].second_child = second;
  return place;
}

Surface::Candidate Surface::closest_on(std::int32_t f, const Vector3& x) const {
  // Closest feature of the triangle, by the Voronoi regions of Ericson, Real-Time Collision Detection, 5.1.5.
  const Face& face = faces_[f];
  const Vector3 &a = points_[face.corner[0]], &b = points_[face.corner[1]], &c = points_[face.corner[2]];
  const Vector3 ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = dot(ab, ax), d2 = dot(ac, ax), d3 = dot(ab, bx), d4 = dot(ac, bx), d5 = dot(ab, cx),
               d6 = dot(ac, cx);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  int feature = 0;
  Vector3 point{};
  if (d1 <= 0.0 && d2 <= 0.0) {
    feature = 4, point = a;
  } else if (d3 >= 0.0 && d4 <= d3) {
    feature = 5, point = b;
  } else if (d6 >= 0.0 && d5 <= d6) {
    feature = 6, point = c;
  } else if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    feature = 1, point = a + share(d1, d1 - d3) * ab;
  } else if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    feature = 2, point = b + share(d4 - d3, (d4 - d3) + (d5 - d6)) * (c - b);
  } else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    feature = 3, point = a + share(d2, d2 - d6) * ac;
  } else {
    const double whole = va + vb + vc;
    point = a + share(vb, whole) * ab + share(vc, whole) * ac;
  }
  // For slivers, rounding can place the point outside the triangle, and so closer to x than the box distance
  // of the tree.
  for (std::size_t k = 0; k < 3; ++k)
    point[k] = std::clamp(point[k], std::min({a[k], b[k], c[k]}), std::max({a[k], b[k], c[k]}));
  return {dot(x - point, x - point), f, feature, point};
}

void Surface::look_at(std::int32_t f, const Vector3& x, Candidate& best) const {
  const Candidate here = closest_on(f, x);
  // Ties go to the lowest face number, independent of the search order.
  if (best.face >= 0 && (here.squared > best.squared || (here.squared == best.squared && f > best.face)))
    return;
  best = here;
}

Vector3 Surface::way_to(const Candidate& found, const Vector3& x) const {
  const Triangle& corner = faces_[found.face].corner;
  const auto along_edge = [&](std::size_t k) {
    const Vector3 &a = points_[corner[k]], &b = points_[corner[(k + 1) % 3]];
    const Wide edge = difference(b, a), way = difference(a, x);
    return rounded_sum(way, -wide_dot(way, edge) / wide_dot(edge, edge), edge);
  };
  if (found.feature > 3) return points_[corner[found.feature - 4]] - x;
  if (found.feature > 0) return along_edge(found.feature - 1);
  const Wide way = difference(points_[corner[0]], x),
             normal = wide_cross(difference(points_[corner[1]], points_[corner[0]]),
                                 difference(points_[corner[2]], points_[corner[0]]));
  return rounded_sum({}, wide_dot(way, normal) / wide_dot(normal, normal), normal);
}

Surface::Closest Surface::describe(const Candidate& found, const Vector3& x) const {
  const Face& face = faces_[found.face];
  const Vector3 way = way_to(found, x);
  if (found.feature == 0) return {found.point, way, face.normal, false, face.normal};
  if (found.feature <= 3) {
    const std::size_t k = found.feature - 1;
    return {found.point, way, face.edge[k], face.border[k], face.normal};
  }
  const std::int32_t corner = face.corner[found.feature - 4];
  return {found.point, way, corner_normals_[corner], border_points_[corner] != 0, face.normal};
}

template <class Squared, class Visit>
void Surface::search(const Vector3& x, const Squared& squared, const Visit& visit) const {
  struct Waiting {
    std::int32_t node;
    double squared;
  };
  std::vector<Waiting> stack{{0, 0.0}};
  while (!stack.empty()) {
    const Waiting next = stack.back();
    stack.pop_back();
    if (next.squared > squared()) continue;
    const TreeNode& node = tree_[next.node];
    if (node.second_child < 0) {
      for (std::int32_t f = node.first; f < node.last; ++f) visit(f);
      continue;
    }
    const std::int32_t first = next.node + 1, second = node.second_child;
    const Waiting a{first, tree_[first].box.squared_distance(x)},
        b{second, tree_[second].box.squared_distance(x)};
    stack.push_back(a.squared < b.squared ? b : a);
    stack.push_back(a.squared < b.squared ? a : b);
  }
}

Surface::Closest Surface::closest(const Vector3& x) const {
  Candidate best;
  best.squared = HUGE_VAL;
  search(
      x, [&] { return best.squared; }, [&](std::int32_t f) { look_at(f, x, best); });
  return describe(best, x);
}

std::vector<Surface::Closest> Surface::within(const Vector3& x, double distance) const {
  const double squared = distance * distance;
  std::vector<Candidate> found;
  search(
      x, [&] { return squared; },
      [&](std::int32_t f) {
        const Candidate here = closest_on(f, x);
        if (here.squared <= squared) found.push_back(here);
      });
  std::sort(found.begin(), found.end(),
            [](const Candidate& a, const Candidate& b) { return a.face < b.face; });
  std::vector<Closest> described;
  for (const Candidate& one : found) described.push_back(describe(one, x));
  return described;
}

Surface::Closest Surface::closest_of_all(const Vector3& x) const {
  Candidate best;
  for (std::size_t f = 0; f < faces_.size(); ++f) look_at(static_cast<std::int32_t>(f), x, best);
  return describe(best, x);
}

}  // namespace kacanov
