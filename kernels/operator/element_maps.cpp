// SPDX-License-Identifier: BSD-3-Clause
// Maps from the reference element to mesh elements: volume and thinness, and the sign of det J by Bézier
// coefficients.
#include "operator/element_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include <kacanov/cells.hpp>
#include "cells/elements.hpp"
#include "simd/row_points.hpp"

namespace kacanov {
namespace {

using Columns = std::array<std::array<double, 3>, 3>;

std::array<double, 3> across(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double inner(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class E>
Columns columns_at(const MeshView& mesh, std::size_t element, const double* xi) {
  constexpr std::size_t dim = E::dim;
  const auto gradients = E::gradients(xi);
  Columns column{};
  const std::size_t first = mesh.connectivity[element * E::nodes];
  for (std::size_t a = 1; a < E::nodes; ++a) {
    const std::size_t node = mesh.connectivity[element * E::nodes + a];
    for (std::size_t k = 0; k < dim; ++k)
      for (std::size_t i = 0; i < dim; ++i)
        column[k][i] +=
            (mesh.coordinates[node * dim + i] - mesh.coordinates[first * dim + i]) * gradients[a * dim + k];
  }
  return column;
}

constexpr ElementMap no_point_yet{.least_det = std::numeric_limits<double>::infinity(),
                                  .most_det = -std::numeric_limits<double>::infinity()};

void add_point(ElementMap& map, double weight, double det, double thinness) {
  map.volume += weight * det;
  map.least_det = std::min(map.least_det, det);
  map.most_det = std::max(map.most_det, det);
  map.thinness = std::min(map.thinness, thinness);
}

double share(double det, double size) {
  return size > 0.0 && size < std::numeric_limits<double>::infinity() ? det / size : 0.0;
}

template <class E>
ElementMap map_of(const MeshView& mesh, std::size_t element) {
  ElementMap map = no_point_yet;
  for (const auto& xi : E::point) {
    const auto [a, b, c] = columns_at<E>(mesh, element, xi.data());
    double det, thinness;
    if constexpr (E::dim == 2) {
      det = a[0] * b[1] - a[1] * b[0];
      thinness = share(2.0 * det, inner(a, a) + inner(b, b));
    } else {
      const auto bc = across(b, c), ca = across(c, a), ab = across(a, b);
      det = inner(a, bc);
      thinness = share(3.0 * det, std::sqrt(inner(a, a) + inner(b, b) + inner(c, c)) *
                                      std::sqrt(inner(bc, bc) + inner(ca, ca) + inner(ab, ab)));
    }
    add_point(map, E::weight, det, thinness);
  }
  return map;
}

template <class E>
class MapRows {
 public:
  explicit MapRows(const MeshView& mesh) : mesh_(mesh) {
    for (std::size_t q = 0; q < E::point.size(); ++q) slopes_[q] = E::gradients(E::point[q].data());
  }

  /// Elements from `first` on; the last element fills the remaining lanes.
  void work_out(std::size_t first, std::array<ElementMap, simd::row_lanes>& out) {
    const std::size_t last = mesh_.element_count() - 1;
    for (std::size_t lane = 0; lane < simd::row_lanes; ++lane) {
      const std::int32_t* node = &mesh_.connectivity[E::nodes * std::min(first + lane, last)];
      for (std::size_t a = 0; a < E::nodes; ++a)
        for (std::size_t i = 0; i < 3; ++i)
          x_[a][i][lane] = mesh_.coordinates[3 * static_cast<std::size_t>(node[a]) + i];
    }
    loops_.take_sides(x_, sides_);
    out.fill(no_point_yet);
    simd::RowMap at;
    for (const auto& slopes : slopes_) {
      loops_.map(slopes.data(), sides_, at);
      for (std::size_t lane = 0; lane < simd::row_lanes; ++lane)
        add_point(out[lane], E::weight, at.det[lane], at.thinness[lane]);
    }
  }

 private:
  const MeshView& mesh_;
  const simd::RowLoops<E::nodes>& loops_ = simd::row_loops<E::nodes>({});
  std::array<std::array<double, E::nodes * 3>, E::point.size()> slopes_;
  simd::RowLanes x_[E::nodes][3];
  typename simd::RowLoops<E::nodes>::Sides sides_;
};

}  // namespace

ElementMap element_map(const MeshView& mesh, std::size_t element) {
  return elements::dispatch(mesh.type, [&]<class E>(E) { return map_of<E>(mesh, element); });
}

void visit_element_maps(const MeshView& mesh,
                        const std::function<void(std::size_t, std::span<const ElementMap>)>& visit) {
  const std::size_t count = mesh.element_count();
  elements::dispatch(mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 2) {
      for (std::size_t e = 0; e < count; ++e) {
        const ElementMap map = map_of<E>(mesh, e);
        visit(e, {&map, 1});
      }
    } else {
      MapRows<E> rows(mesh);
      std::array<ElementMap, simd::row_lanes> maps;
      for (std::size_t first = 0; first < count; first += maps.size()) {
        rows.work_out(first, maps);
        visit(first, std::span(maps).first(std::min(maps.size(), count - first)));
      }
    }
  });
}

namespace jacobian_sign {
namespace {

/// Relative to the largest Bézier coefficient: smaller negative determinants may be 0 in exact coordinates,
/// as at the tip of quarter-point elements, and negative through rounding in a file.
constexpr double rounded_to_zero = 1e-6;
/// After this many subdomains a determinant that touches 0 counts as not negative.
constexpr std::size_t most_subdomains = 4096;

using Point = std::array<double, 3>;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Point cross_product(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double inner_product(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(inner_product(a, a)); }
double determinant(const Point& a, const Point& b, const Point& c) {
  return inner_product(a, cross_product(b, c));
}
Point middle_of(const Point& a, const Point& b) { return 0.5 * (a + b); }

/// Columns of J and reference coordinates at the corners of a subdomain; linear between the corners of a
/// simplex, multilinear between those of a box. Corner k of a box lies at the upper end along axis i if bit i
/// of k is set.
template <std::size_t corners>
struct Subdomain {
  std::array<std::array<Point, corners>, 3> column{};
  std::array<Point, corners> xi{};

  double det(std::size_t corner) const {
    return determinant(column[0][corner], column[1][corner], column[2][corner]);
  }
  template <class Change>
  void change(const Change& change) {
    for (auto& one : column) change(one);
    change(xi);
  }
};

struct Range {
  double least = HUGE_VAL, most = -HUGE_VAL;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// A coefficient of the product of three linear functions is the average of all products with its index.
template <std::size_t count>
class Coefficients {
 public:
  void add(std::size_t index, double product) {
    sum_[index] += product;
    ++products_[index];
  }
  Range range() const {
    Range range;
    for (std::size_t i = 0; i < count; ++i)
      if (products_[i] > 0) range.add(sum_[i] / products_[i]);
    return range;
  }

 private:
  std::array<double, count> sum_{};
  std::array<int, count> products_{};
};

/// Degree 3 on a tetrahedron: det J of tet10.
Range coefficients(const Subdomain<4>& part) {
  Coefficients<64> all;  // indexed by the multiplicities of all corners but the first; 20 are used
  constexpr std::array<std::size_t, 4> place{0, 1, 4, 16};
  for (std::size_t q = 0; q < 4; ++q)
    for (std::size_t r = 0; r < 4; ++r) {
      const Point normal = cross_product(part.column[1][q], part.column[2][r]);
      for (std::size_t p = 0; p < 4; ++p)
        all.add(place[p] + place[q] + place[r], inner_product(part.column[0][p], normal));
    }
  return all.range();
}

/// Degree 2 along each axis of a cube: det J of hex8. A column does not vary along its own axis.
Range coefficients(const Subdomain<8>& part) {
  Coefficients<27> all;
  const auto along = [](std::size_t corner, std::size_t axis) { return corner >> axis & 1; };
  for (const std::size_t q : {0, 1, 4, 5})
    for (const std::size_t r : {0, 1, 2, 3}) {
      const Point normal = cross_product(part.column[1][q], part.column[2][r]);
      for (const std::size_t p : {0, 2, 4, 6})
        all.add(along(q, 0) + along(r, 0) + 3 * (along(p, 1) + along(r, 1)) + 9 * (along(p, 2) + along(q, 2)),
                inner_product(part.column[0][p], normal));
    }
  return all.range();
}

/// Eight tetrahedra: one at each corner, four around a diagonal of the octahedron between them.
std::array<Subdomain<4>, 8> split(const Subdomain<4>& whole) {
  constexpr std::array<std::array<int, 2>, 10> ends{
      {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  constexpr std::array<std::array<int, 4>, 8> of{{{0, 4, 5, 6},
                                                  {4, 1, 7, 8},
                                                  {5, 7, 2, 9},
                                                  {6, 8, 9, 3},
                                                  {5, 8, 4, 6},
                                                  {5, 8, 6, 9},
                                                  {5, 8, 9, 7},
                                                  {5, 8, 7, 4}}};
  std::array<Subdomain<4>, 8> parts;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part] = whole;
    parts[part].change([&](std::array<Point, 4>& values) {
      const std::array<Point, 4> before = values;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& [a, b] = ends[of[part][k]];
        values[k] = middle_of(before[a], before[b]);
      }
    });
  }
  return parts;
}

/// Eight octants.
std::array<Subdomain<8>, 8> split(const Subdomain<8>& whole) {
  std::array<Subdomain<8>, 8> parts;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part] = whole;
    parts[part].change([&](std::array<Point, 8>& values) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 8; ++k) {
          if ((k >> axis & 1) != 0) continue;
          Point &lower = values[k], &upper = values[k | std::size_t{1} << axis];
          ((part >> axis & 1) != 0 ? lower : upper) = middle_of(lower, upper);
        }
    });
  }
  return parts;
}

/// Sufficient condition without coefficients: det J is positive if the columns vary little.
template <std::size_t corners>
bool varies_little(const Subdomain<corners>& whole) {
  std::array<Point, 3> mean{};
  double lengths = 1.0, most = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const Point& one : whole.column[i]) mean[i] = mean[i] + 1.0 / corners * one;
    double off = 0.0;
    for (const Point& one : whole.column[i]) off = std::max(off, length(one - mean[i]));
    lengths *= length(mean[i]);
    most *= length(mean[i]) + off;
  }
  return determinant(mean[0], mean[1], mean[2]) > most - lengths;
}

/// The corner with the smallest det J.
template <std::size_t corners>
std::size_t worst_corner(const Subdomain<corners>& part) {
  std::size_t worst = 0;
  for (std::size_t k = 1; k < corners; ++k)
    if (part.det(k) < part.det(worst)) worst = k;
  return worst;
}

template <std::size_t corners>
struct Found {
  double det = 0.0;
  Point xi{};
};

/// Coefficients bound det J from below, corner values from above: subdomains between the bounds are split.
template <std::size_t corners>
std::optional<Found<corners>> search(const Subdomain<corners>& whole) {
  if (varies_little(whole)) return std::nullopt;
  const Range range = coefficients(whole);
  const double least = -rounded_to_zero * std::max(range.most, -range.least);
  std::deque<Subdomain<corners>> open{whole};
  for (std::size_t looked = 0; !open.empty() && looked < most_subdomains; ++looked) {
    const Subdomain<corners> part = open.front();
    open.pop_front();
    const std::size_t worst = worst_corner(part);
    if (const double det = part.det(worst); det < least) return Found<corners>{det, part.xi[worst]};
    if (coefficients(part).least >= least) continue;
    for (const Subdomain<corners>& smaller : split(part)) open.push_back(smaller);
  }
  return std::nullopt;
}

Point node_position(const MeshView& mesh, std::size_t element, std::size_t node) {
  const std::size_t dim = dimension(mesh.type), nodes = nodes_per_element(mesh.type);
  const double* x =
      &mesh.coordinates[dim * static_cast<std::size_t>(mesh.connectivity[element * nodes + node])];
  return {x[0], x[1], dim == 3 ? x[2] : 0.0};
}

/// ∂x/∂Lₐ at corner p is 3 x_p for a = p, else 4 times the mid-side node minus xₐ; ∂/∂ξ_k = ∂/∂L_{k+1} −
/// ∂/∂L₀.
Subdomain<4> quadratic_tetrahedron(const MeshView& mesh, std::size_t element) {
  Subdomain<4> whole;
  std::array<std::array<Point, 4>, 4> slope;  // corner, barycentric coordinate
  std::array<Point, 4> x;
  for (std::size_t p = 0; p < 4; ++p) x[p] = node_position(mesh, element, p);
  for (std::size_t p = 0; p < 4; ++p) slope[p][p] = 3.0 * x[p];
  for (const CellEdge& edge : cell(mesh.type).edges) {
    const Point four = 4.0 * node_position(mesh, element, edge.middle);
    const std::size_t a = edge.a, b = edge.b;
    slope[a][b] = four - x[b];
    slope[b][a] = four - x[a];
  }
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t k = 0; k < 3; ++k) {
      whole.column[k][p] = slope[p][k + 1] - slope[p][0];
      whole.xi[p][k] = p == k + 1 ? 1.0 : 0.0;
    }
  return whole;
}

/// Corners of a square or cube [−1, 1]^dim as bits; a square is extended to a prism of height 2.
Subdomain<8> multilinear(const MeshView& mesh, std::size_t element) {
  const Cell& type = cell(mesh.type);
  Subdomain<8> whole;
  std::array<Point, 8> x;
  for (std::size_t node = 0; node < static_cast<std::size_t>(type.nodes); ++node) {
    std::size_t corner = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(type.dim); ++i)
      if (type.reference[node][i] > 0.0) corner |= std::size_t{1} << i;
    x[corner] = node_position(mesh, element, node);
    if (type.dim == 2) x[corner | 4] = x[corner] + Point{0.0, 0.0, 2.0};
  }
  for (std::size_t k = 0; k < 8; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t bit = std::size_t{1} << i;
      whole.column[i][k] = 0.5 * (x[k | bit] - x[k & ~bit]);
      whole.xi[k][i] = (k & bit) != 0 ? 1.0 : -1.0;
    }
  return whole;
}

std::size_t nearest_corner_to(const Cell& type, const Point& xi) {
  std::size_t nearest = 0;
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < static_cast<std::size_t>(type.corners); ++k) {
    Point off = xi - type.reference[k];
    if (type.dim == 2) off[2] = 0.0;
    if (!(length(off) < least)) continue;
    least = length(off);
    nearest = k;
  }
  return nearest;
}

template <std::size_t corners>
std::optional<NegativeJacobian> search_element(const MeshView& mesh, const Subdomain<corners>& whole) {
  const auto found = search(whole);
  if (!found) return std::nullopt;
  return NegativeJacobian{found->det, nearest_corner_to(cell(mesh.type), found->xi)};
}

}  // namespace
}  // namespace jacobian_sign

std::optional<NegativeJacobian> find_negative_jacobian(const MeshView& mesh, std::size_t element) {
  const Cell& type = cell(mesh.type);
  using namespace jacobian_sign;
  if (!type.simplex) return search_element(mesh, multilinear(mesh, element));
  if (type.order == 1) return std::nullopt;
  return search_element(mesh, quadratic_tetrahedron(mesh, element));
}

}  // namespace kacanov
