// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of a solution, a run of elements at a time.
#include <kacanov/element_fields.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>

#include <kacanov/corner_means.hpp>
#include "field_loops.hpp"
#include "linear/free_strain.hpp"
#include "problem/shapes.hpp"

namespace kacanov {
namespace {

constexpr std::size_t elements_a_run = 4096;

/// Elements in a row, with what they would be longer by in plane stress.
struct Elements {
  Body body;
  std::vector<double> free_strain;

  Elements(const Body& given, std::span<const double> thermal) : body(given) {
    if (body.mesh.plane != PlaneState::stress || thermal.empty()) return;
    free_strain = kacanov::free_strain(body, thermal);
    body.free_strain = free_strain;
  }
  Elements(const Part& part, const BodyState& state, std::size_t first, std::size_t count)
      : Elements(some_of(part, first, count), part.plane != PlaneState::stress || state.thermal.empty()
                                                  ? std::span<const double>()
                                                  : state.thermal.subspan(first, count)) {
    if (corner_moduli(part.body()).empty()) return;
    const std::size_t corners = cell(part.type).corners;
    if (state.corner_dilatation.size() != corners * part.element_count())
      throw std::logic_error("the state lacks its means of tr ε round the corners");
    body.corner_dilatation = state.corner_dilatation.subspan(first * corners, count * corners);
  }
  Elements(const Elements&) = delete;
  Elements& operator=(const Elements&) = delete;

 private:
  static Body some_of(const Part& part, std::size_t first, std::size_t count) {
    const std::size_t npe = nodes_per_element(part.type);
    Body some = part.body();
    some.mesh.connectivity = some.mesh.connectivity.subspan(first * npe, count * npe);
    if (!some.law_of_element.empty()) some.law_of_element = some.law_of_element.subspan(first, count);
    return some;
  }
};

/// Takes the means of elements from `first` on, or what their points have, off their stresses; in plane
/// stress these know of it.
class ThermalStress {
 public:
  ThermalStress(const MeshView& mesh, std::size_t elements, std::span<const double> thermal)
      : thermal_(thermal) {
    if (mesh.plane == PlaneState::stress) thermal_ = {};
    if (thermal_.empty()) return;
    width_ = thermal.size() / elements;
    const Cell& type = cell(mesh.type);
    for (const auto& at : type.points) {
      shape_.emplace_back();
      corner_cell(type).values(at.data(), shape_.back().data());
    }
  }
  void take_off_means(std::size_t first, std::span<double> stress) const {
    if (thermal_.empty()) return;
    for (std::size_t k = 0; k < stress.size() / 6; ++k)
      for (std::size_t c = 0; c < 3; ++c) stress[6 * k + c] -= thermal_[(first + k) * width_];
  }
  void take_off_points(std::size_t first, std::span<double> stress) const {
    if (thermal_.empty()) return;
    for (std::size_t k = 0; k < stress.size() / 6; ++k) {
      const double* element = &thermal_[(first + k / shape_.size()) * width_];
      double here = width_ == 1 ? element[0] : 0.0;
      for (std::size_t a = 1; a < width_; ++a) here += shape_[k % shape_.size()][a - 1] * element[a];
      for (std::size_t c = 0; c < 3; ++c) stress[6 * k + c] -= here;
    }
  }

 private:
  std::span<const double> thermal_;
  std::size_t width_ = 1;
  std::vector<std::array<double, most_nodes>> shape_;  ///< of the corners, at each point
};

}  // namespace

void element_fields(const Part& part, const BodyState& state, std::size_t first, std::size_t count,
                    const reference::ElementFields& out) {
  field_loops(part.type).fields(Elements(part, state, first, count).body, state.u, out);
  if (!out.stress.empty())
    ThermalStress(part.body().mesh, part.element_count(), state.thermal).take_off_means(first, out.stress);
}

void element_fields(const Body& body, const BodyState& state, const reference::ElementFields& out) {
  field_loops(body.mesh.type).fields(Elements(body, state.thermal).body, state.u, out);
  if (!out.stress.empty())
    ThermalStress(body.mesh, body.mesh.element_count(), state.thermal).take_off_means(0, out.stress);
}

void element_strains(const Part& part, const BodyState& state, std::size_t first, std::size_t count,
                     std::span<double> out) {
  const std::size_t points = points_per_element(part.type);
  const Elements some(part, state, first, count);
  if (points == 1) return field_loops(part.type).point_fields(some.body, state.u, {{}, {}, out, {}});
  std::vector<double> strain(6 * count * points), volume(count * points);
  field_loops(part.type).point_fields(some.body, state.u, {{}, {}, strain, volume});
  for (std::size_t e = 0; e < count; ++e) {
    double whole = 0.0;
    std::array<double, 6> sum{};
    for (std::size_t q = e * points; q < (e + 1) * points; ++q) {
      whole += volume[q];
      for (std::size_t c = 0; c < 6; ++c) sum[c] += volume[q] * strain[6 * q + c];
    }
    for (std::size_t c = 0; c < 6; ++c) out[6 * e + c] = sum[c] / whole;
  }
}

void visit_element_fields(const Part& part, const BodyState& state,
                          const std::function<void(const ElementRun&)>& visit) {
  const std::size_t elements = part.element_count();
  ElementRun run;
  for (run.first = 0; run.first < elements; run.first += elements_a_run) {
    const std::size_t count = std::min(elements_a_run, elements - run.first);
    run.stress.resize(6 * count);
    for (auto* field :
         {&run.von_mises, &run.dev_strain, &run.secant, &run.strain, &run.rotation, &run.volume})
      field->resize(count);
    run.plastic.resize(count);
    element_fields(part, state, run.first, count,
                   {run.stress, run.von_mises, run.dev_strain, run.secant, run.plastic, run.strain,
                    run.rotation, run.volume});
    visit(run);
  }
}

void visit_points(const Part& part, const BodyState& state, PointValues wanted,
                  const std::function<void(const PointRun&)>& visit) {
  const std::size_t elements = part.element_count();
  const std::size_t points = points_per_element(part.type);
  const ThermalStress thermal(part.body().mesh, elements, state.thermal);
  PointRun run;
  for (run.first = 0; run.first < elements; run.first += elements_a_run) {
    const std::size_t count = std::min(elements_a_run, elements - run.first);
    run.position.resize(count * points);
    run.stress.resize(wanted == PointValues::all ? 6 * count * points : 0);
    run.strain.resize(6 * count * points);
    run.volume.resize(count * points);
    field_loops(part.type).point_fields(Elements(part, state, run.first, count).body, state.u,
                                        {run.position, run.stress, run.strain, run.volume});
    thermal.take_off_points(run.first, run.stress);
    visit(run);
  }
}

ElementNumbers element_numbers(const Part& part, const BodyState& state) {
  const std::size_t elements = part.element_count();
  ElementNumbers out;
  for (auto* field : {&out.von_mises, &out.dev_strain, &out.secant, &out.volume}) field->resize(elements);
  out.plastic.resize(elements);
  element_fields(part, state, 0, elements,
                 {{}, out.von_mises, out.dev_strain, out.secant, out.plastic, {}, {}, out.volume});
  return out;
}

NodalMeans nodal_means(const Part& part, const ElementNumbers& of) {
  const std::size_t npe = nodes_per_element(part.type);
  NodalMeans means{std::vector<double>(part.nodes(), 0.0), std::vector<double>(part.nodes(), 0.0)};
  std::vector<double> weight(part.nodes(), 0.0);
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    const auto node = static_cast<std::size_t>(part.elements[k]);
    const std::size_t e = k / npe;
    means.von_mises[node] += of.volume[e] * of.von_mises[e];
    means.plastic_share[node] += of.plastic[e] != 0 ? of.volume[e] : 0.0;
    weight[node] += of.volume[e];
  }
  for (auto* sum : {&means.von_mises, &means.plastic_share, &weight}) part.node_map.sum(*sum, 1);
  for (std::size_t n = 0; n < weight.size(); ++n) {
    means.von_mises[n] /= weight[n];
    means.plastic_share[n] /= weight[n];
  }
  return means;
}

double stored_energy(const Body& body, std::span<const double> u) {
  return field_loops(body.mesh.type).energy(body, u);
}

}  // namespace kacanov
