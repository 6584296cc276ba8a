// SPDX-License-Identifier: BSD-3-Clause
// Element stiffness matrices in closed form, for multigrid setups.
#include "reference/element_stiffness.hpp"

#include <algorithm>

#include "cells/dispatch.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"

namespace kacanov {

void element_stiffness(const Body& body, std::size_t element, std::span<const double> g,
                       std::span<double> matrix) {
  const Law& law = body.law(element);
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    using Point = elements::Point<E>;
    constexpr std::size_t width = E::nodes * E::dim;
    elements::Nodal<E> x;
    const std::int32_t* node = body.mesh.connectivity.data() + element * E::nodes;
    for (int a = 0; a < E::nodes; ++a)
      for (int i = 0; i < E::dim; ++i) x[Point::at(a, i)] = body.mesh.coordinates[Point::at(node[a], i)];
    std::fill_n(matrix.begin(), width * width, 0.0);
    const auto points = elements::points_of<E>(x, law.mean_dilatation, body.mesh.plane);
    for (std::size_t q = 0; q < E::points; ++q) {
      const Point& point = points[q];
      const double shear = point.volume * g[q],
                   modulus =
                       body.mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g[q]) : law.bulk,
                   bulk = point.volume * modulus;
      for (int a = 0; a < E::nodes; ++a)
        for (int b = a; b < E::nodes; ++b) {  // the rest by symmetry
          const double* p = point.gradient[a];
          const double* r = point.gradient[b];
          const double* mean_p = point.dilatation[a];
          const double* mean_r = point.dilatation[b];
          double product = 0.0;
          for (int k = 0; k < E::dim; ++k) product += p[k] * r[k];
          const double hoop = 2.0 * point.hoop[a] * point.hoop[b];
          for (int i = 0; i < E::dim; ++i)
            for (int j = 0; j < E::dim; ++j)
              matrix[Point::at(a, i) * width + Point::at(b, j)] +=
                  bulk * mean_p[i] * mean_r[j] +
                  shear * (p[j] * r[i] - 2.0 / 3.0 * point.trace(a, i) * point.trace(b, j) +
                           (i == j ? product + (i == 0 ? hoop : 0.0) : 0.0));
        }
    }
    for (std::size_t row = 0; row < width; ++row)
      for (std::size_t column = 0; column < row; ++column)
        matrix[row * width + column] = matrix[column * width + row];
  });
}

}  // namespace kacanov
