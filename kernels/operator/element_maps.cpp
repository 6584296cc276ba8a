// SPDX-License-Identifier: BSD-3-Clause
// Maps from the reference element, one by one or several at a time.
#include "operator/element_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cells/dispatch.hpp"
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

}  // namespace kacanov
