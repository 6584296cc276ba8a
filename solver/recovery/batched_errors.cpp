// SPDX-License-Identifier: BSD-3-Clause
// Error of the strains relative to recovered ones, in batches of elements.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "cells/elements.hpp"
#include "recovery/element_batch.hpp"
#include "recovery/error_quadrature.hpp"
#include "recovery/spr_patches.hpp"

namespace kacanov {
namespace {

/// Compares the strains of a batch of elements with recovered ones.
template <class Element>
class ErrorRows {
 public:
  explicit ErrorRows(const Smoothing& of)
      : of_(of), body_(of.part.body()), points_(error_quadrature_points(cell(of.part.type))) {}

  /// Computes the error energy of each element of the batch.
  void work_out(const ElementBatch& row, Lanes& energy) {
    gather(body_.mesh, row, body_.mesh.coordinates, x_);
    gather(body_.mesh, row, of_.state.u, moved_);
    loops_.take_sides(x_, sides_);
    loops_.take_sides(moved_, moved_sides_);
    for (std::size_t lane = 0; lane < batch_size; ++lane) take(row[lane], lane);
    energy.fill(0.0);
    simd::RowPoint here;
    simd::RowStrain smooth;
    Lanes position[3], weight, g, smooth_g;
    for (const ErrorQuadraturePoint& point : points_) {
      const bool even = Element::nodes == 4 && &point != points_.data();  // the same as at the first point
      if (!even) {
        loops_.strain(point.gradient.data(), sides_, moved_sides_, here);
        put_means(point, here.strain.trace);
        find_secants(here.strain.norm, g);
      }
      loops_.position(point.value.data(), x_, position);
      loops_.smooth(point.corner_share.data(), polynomial_, position, smooth);
      find_secants(smooth.norm, smooth_g);
      for (std::size_t lane = 0; lane < batch_size; ++lane) weight[lane] = point.weight * here.det[lane];
      loops_.add_work({here.strain, smooth, g, smooth_g, bulk_}, weight, energy);
    }
  }

 private:
  using Loops = simd::RowLoops<Element::nodes>;

  /// Loads the data of an element into a lane.
  void take(std::size_t element, std::size_t lane) {
    law_[lane] = &body_.law(element);
    bulk_[lane] = law_[lane]->bulk;
    const std::int32_t* node = &of_.part.elements[element * Element::nodes];
    for (std::size_t a = 0; a < Loops::corners; ++a) {
      const auto of = of_.patches.polynomial(of_.fits, of_.set, static_cast<std::size_t>(node[a]));
      for (std::size_t i = 0; i < 3; ++i) polynomial_[a].centre[i][lane] = of.centre[i];
      polynomial_[a].scale[lane] = of.scale;
      for (std::size_t k = 0; k < Loops::terms; ++k)
        for (std::size_t v = 0; v < 6; ++v)
          polynomial_[a].coefficient[k][v][lane] = of.coefficients[6 * k + v];
    }
    averaged_[lane] = law_[lane]->mean_dilatation;
    if (!averaged_[lane]) return;
    const bool at_corners = Element::order > 1 && averages_at_corners(*law_[lane], of_.part.type);
    for (std::size_t a = 0; a < Loops::corners; ++a)
      trace_[a][lane] =
          at_corners ? of_.state.corner_dilatation[element * Loops::corners + a] : of_.mean_trace[element];
  }

  /// Replaces the trace by means of tr ε for laws that use them.
  void put_means(const ErrorQuadraturePoint& point, Lanes& trace) const {
    for (std::size_t lane = 0; lane < batch_size; ++lane) {
      if (!averaged_[lane]) continue;
      trace[lane] = 0.0;
      for (std::size_t a = 0; a < Loops::corners; ++a) trace[lane] += point.corner_share[a] * trace_[a][lane];
    }
  }

  void find_secants(const Lanes& norm, Lanes& g) const {
    for (std::size_t lane = 0; lane < batch_size; ++lane) g[lane] = law_[lane]->secant(norm[lane]);
  }

  const Smoothing& of_;
  Body body_;
  std::vector<ErrorQuadraturePoint> points_;
  const Loops& loops_ = simd::row_loops<Element::nodes>({});
  Lanes x_[Element::nodes][3], moved_[Element::nodes][3], bulk_, trace_[Loops::corners];
  typename Loops::Sides sides_, moved_sides_;
  std::array<const Law*, batch_size> law_;
  std::array<bool, batch_size> averaged_;
  typename Loops::Polynomials polynomial_;
};

template <class Element>
void errors_of(const Smoothing& of, std::int32_t batch, std::span<double> energy) {
  ErrorRows<Element> rows(of);
  ElementBatch row;
  std::size_t count = 0;
  const auto finish = [&] {
    if (count == 0) return;
    std::fill(row.begin() + static_cast<std::ptrdiff_t>(count), row.end(), row[count - 1]);
    Lanes of_row;
    rows.work_out(row, of_row);
    for (std::size_t lane = 0; lane < count; ++lane) energy[row[lane]] = of_row[lane];
    count = 0;
  };
  for (std::size_t e = 0; e < energy.size(); ++e) {
    if (!of.patches.is_in(e, batch)) continue;
    row[count++] = e;
    if (count == batch_size) finish();
  }
  finish();
}

}  // namespace

void batched_errors(const Smoothing& of, std::int32_t batch, std::span<double> energy) {
  switch (of.part.type) {
    case ElementType::tet4: return errors_of<elements::Tet4>(of, batch, energy);
    case ElementType::tet10: return errors_of<elements::Tet10>(of, batch, energy);
    case ElementType::hex8: return errors_of<elements::Hex8>(of, batch, energy);
    default: throw std::logic_error("no batched loop for " + std::string(cell(of.part.type).name));
  }
}

ErrorLoop error_loop(ElementType type) { return cell(type).dim == 3 ? batched_errors : reference_errors; }

}  // namespace kacanov
