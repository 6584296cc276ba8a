// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of trilinear hexahedra and of quadratic tetrahedra, which differ from point to point.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cells/hex8.hpp"
#include "cells/tet10.hpp"
#include "field_loops.hpp"
#include "lanes.hpp"
#include "reference/element_points.hpp"

namespace kacanov {
namespace {

using reference::CornerDilatation;

using simd::RowPoint, simd::RowStrain;

/// Elements in a row with what their points have: 140 ns a tet10 against 610 of the reference.
template <class Element>
struct Row {
  std::size_t first = 0, count = 0;
  Lanes x[Element::nodes][3];
  RowPoint at[Element::points];
  Lanes weight[Element::points];  ///< the points' volumes
  Lanes square[Element::points];  ///< of the trace, as the energy has it
  Lanes volume;
  const Law* law[abreast];
  const simd::RowLoops<Element::nodes>& loops = simd::row_loops<Element::nodes>({});

  /// `means`: none where nobody asks for strains.
  void work_out(const Body& body, std::span<const double> u, const CornerDilatation* means) {
    const std::size_t elements = body.mesh.element_count();
    const ElementsAbreast row = in_a_row(first, elements);
    count = std::min(abreast, elements - first);
    bool mean_dilatation = false;
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      law[lane] = &body.law(row[lane]);
      mean_dilatation = mean_dilatation || law[lane]->mean_dilatation;
    }
    gather(body.mesh, row, body.mesh.coordinates, x);
    gather(body.mesh, row, u, moved_);
    loops.take_sides(x, sides_);
    loops.take_sides(moved_, moved_sides_);
    volume.fill(0.0);
    for (std::size_t q = 0; q < Element::points; ++q) {
      loops.strain(Element::gradients(Element::point[q].data()).data(), sides_, moved_sides_, at[q]);
      for (std::size_t lane = 0; lane < abreast; ++lane) {
        weight[q][lane] = Element::weight * at[q].det[lane];
        volume[lane] += weight[q][lane];
      }
    }
    if (means == nullptr) return;
    if (mean_dilatation && Element::mean_dilatation) average_traces();
    for (std::size_t q = 0; q < Element::points; ++q)
      for (std::size_t lane = 0; lane < abreast; ++lane)
        square[q][lane] = at[q].strain.trace[lane] * at[q].strain.trace[lane];
    if (mean_dilatation && Element::corner_dilatation) put_means(row, *means);
  }

 private:
  void average_traces() {
    Lanes mean{};
    for (std::size_t q = 0; q < Element::points; ++q)
      for (std::size_t lane = 0; lane < abreast; ++lane)
        mean[lane] += weight[q][lane] * at[q].strain.trace[lane];
    for (std::size_t lane = 0; lane < abreast; ++lane)
      if (law[lane]->mean_dilatation)
        for (RowPoint& point : at) point.strain.trace[lane] = mean[lane] / volume[lane];
  }

  void put_means(const ElementsAbreast& row, const CornerDilatation& means) {
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      if (!law[lane]->mean_dilatation) continue;
      for (std::size_t q = 0; q < Element::points; ++q) {
        reference::Strain at_point;
        means.put<Element>(*law[lane], row[lane], q, at_point);
        at[q].strain.trace[lane] = at_point.trace;
        square[q][lane] = at_point.square;
      }
    }
  }

  Lanes moved_[Element::nodes][3];
  typename simd::RowLoops<Element::nodes>::Sides sides_, moved_sides_;
};

/// Calls visit(row).
template <class Element, class Visit>
void for_each_row(const Body& body, std::span<const double> u, const CornerDilatation* means,
                  const Visit& visit) {
  Row<Element> row;
  for (; row.first < body.mesh.element_count(); row.first += abreast) {
    row.work_out(body, u, means);
    visit(row);
  }
}
template <class Element, class Visit>
void for_each_row(const Body& body, std::span<const double> u, const Visit& visit) {
  const CornerDilatation means(body, u, body.corner_dilatation);
  for_each_row<Element>(body, u, &means, visit);
}

template <class Element>
Lanes secants(const Row<Element>& row, const Lanes& norm) {
  Lanes g;
  for (std::size_t lane = 0; lane < abreast; ++lane) g[lane] = row.law[lane]->secant(norm[lane]);
  return g;
}

void add(Lanes& sum, const Lanes& weight, const Lanes& value) {
  for (std::size_t lane = 0; lane < abreast; ++lane) sum[lane] += weight[lane] * value[lane];
}

template <class Element>
void put(const Row<Element>& row, const Lanes& sum, std::span<double> out) {
  for (std::size_t lane = 0; lane < row.count && !out.empty(); ++lane)
    out[row.first + lane] = sum[lane] / row.volume[lane];
}

/// Means over the points.
template <class Element>
void put_stress(const Row<Element>& row, const reference::ElementFields& out) {
  if (out.stress.empty() && out.von_mises.empty() && out.secant.empty()) return;
  Lanes stress[6] = {}, von_mises{}, secant{};
  Lanes trace{};
  for (std::size_t q = 0; q < Element::points; ++q) {
    const RowStrain& strain = row.at[q].strain;
    const Lanes& volume = row.weight[q];
    const Lanes g = secants(row, strain.norm);
    add(secant, volume, g);
    add(trace, volume, strain.trace);
    for (std::size_t lane = 0; lane < abreast; ++lane) {
      const double twice = 2.0 * volume[lane] * g[lane];
      von_mises[lane] += twice * strain.norm[lane];
      for (std::size_t c = 0; c < 6; ++c) stress[c][lane] += twice * strain.dev[c][lane];
    }
  }
  put(row, secant, out.secant);
  for (double& v : von_mises) v *= std::sqrt(1.5);
  put(row, von_mises, out.von_mises);
  if (out.stress.empty()) return;
  for (std::size_t lane = 0; lane < row.count; ++lane)
    for (std::size_t c = 0; c < 6; ++c)
      out.stress[6 * (row.first + lane) + c] =
          (stress[c][lane] + (c < 3 ? row.law[lane]->bulk * trace[lane] : 0.0)) / row.volume[lane];
}

/// Largest values of the points.
template <class Element>
void put_largest(const Row<Element>& row, const reference::ElementFields& out) {
  Lanes strain{}, rotation{};
  for (const RowPoint& at : row.at) row.loops.raise(at, strain, rotation);
  if (!out.strain.empty()) std::copy_n(strain.begin(), row.count, &out.strain[row.first]);
  if (!out.rotation.empty()) std::copy_n(rotation.begin(), row.count, &out.rotation[row.first]);
}

template <class Element>
void fields(const Body& body, std::span<const double> u, const reference::ElementFields& out) {
  for_each_row<Element>(body, u, [&](const Row<Element>& row) {
    put_stress(row, out);
    if (!out.strain.empty() || !out.rotation.empty()) put_largest(row, out);
    Lanes dev_strain{}, largest{};
    for (std::size_t q = 0; q < Element::points; ++q) {
      add(dev_strain, row.weight[q], row.at[q].strain.norm);
      for (std::size_t lane = 0; lane < abreast; ++lane)
        largest[lane] = std::max(largest[lane], row.at[q].strain.norm[lane]);
    }
    put(row, dev_strain, out.dev_strain);
    for (std::size_t lane = 0; lane < row.count; ++lane) {
      const std::size_t e = row.first + lane;
      if (!out.plastic.empty()) out.plastic[e] = row.law[lane]->plastic(largest[lane]) ? 1 : 0;
      if (!out.volume.empty()) out.volume[e] = row.volume[lane];
    }
  });
}

template <class Element>
void point_fields(const Body& body, std::span<const double> u, const reference::PointFields& out) {
  for_each_row<Element>(body, u, [&](const Row<Element>& row) {
    for (std::size_t q = 0; q < Element::points; ++q) {
      const RowStrain& strain = row.at[q].strain;
      const auto place = [&](std::size_t lane) { return (row.first + lane) * Element::points + q; };
      if (!out.stress.empty()) {
        const Lanes g = secants(row, strain.norm);
        for (std::size_t lane = 0; lane < row.count; ++lane)
          for (std::size_t c = 0; c < 6; ++c)
            out.stress[6 * place(lane) + c] = 2.0 * g[lane] * strain.dev[c][lane] +
                                              (c < 3 ? row.law[lane]->bulk * strain.trace[lane] : 0.0);
      }
      for (std::size_t lane = 0; lane < row.count && !out.strain.empty(); ++lane)
        for (std::size_t c = 0; c < 6; ++c)
          out.strain[6 * place(lane) + c] = strain.dev[c][lane] + (c < 3 ? strain.trace[lane] / 3.0 : 0.0);
      for (std::size_t lane = 0; lane < row.count && !out.volume.empty(); ++lane)
        out.volume[place(lane)] = row.weight[q][lane];
      if (out.position.empty()) continue;
      Lanes position[3];
      row.loops.position(Element::values(Element::point[q].data()).data(), row.x, position);
      for (std::size_t lane = 0; lane < row.count; ++lane)
        for (std::size_t i = 0; i < 3; ++i) out.position[place(lane)][i] = position[i][lane];
    }
  });
}

template <class Element>
double energy(const Body& body, std::span<const double> u) {
  double sum = 0.0;
  for_each_row<Element>(body, u, [&](const Row<Element>& row) {
    for (std::size_t q = 0; q < Element::points; ++q)
      for (std::size_t lane = 0; lane < row.count; ++lane)
        sum += row.weight[q][lane] * (0.5 * row.law[lane]->bulk * row.square[q][lane] +
                                      2.0 * row.law[lane]->energy(row.at[q].strain.norm[lane]));
  });
  return sum;
}

template <class Element>
void volumes(const Body& body, std::span<double> volume) {
  for_each_row<Element>(body, body.mesh.coordinates, nullptr, [&](const Row<Element>& row) {
    std::copy_n(row.volume.begin(), row.count, &volume[row.first]);
  });
}

template <class Element>
constexpr FieldLoops loops_of{fields<Element>, point_fields<Element>, energy<Element>, volumes<Element>};

}  // namespace

const FieldLoops hex8_loops = loops_of<elements::Hex8>, tet10_loops = loops_of<elements::Tet10>;

}  // namespace kacanov
