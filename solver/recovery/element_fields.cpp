// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of a solution for ranges of elements.
#include <kacanov/element_fields.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <kacanov/corner_means.hpp>
#include <kacanov/vector3.hpp>
#include "cells/elements.hpp"
#include "linear/reference_response.hpp"
#include "problem/shapes.hpp"
#include "recovery/element_batch.hpp"
#include "reference/element_points.hpp"

namespace kacanov {
namespace {

constexpr std::size_t elements_a_run = 4096;

/// A range of elements with its free strains in plane stress.
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

/// Subtracts the thermal pressure from the stresses of elements from `first` on, or of their points; nothing
/// in plane stress, where stresses already include it.
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
  std::vector<std::array<double, most_nodes>> shape_;  ///< corner shape functions at each point
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

namespace {

constexpr FieldLoops plain_loops{reference::fields, reference::point_fields, reference::energy,
                                 reference::volumes};

}  // namespace

const FieldLoops& field_loops(ElementType type) {
  switch (type) {
    case ElementType::tet4: return tet4_loops;
    case ElementType::hex8: return hex8_loops;
    case ElementType::tet10: return tet10_loops;
    default: return plain_loops;
  }
}

}  // namespace kacanov

namespace kacanov::tet4 {
namespace {

/// A batch of tet4 elements: 30 ns per element against 100 ns in the reference.
struct BatchState {
  Lanes x[4][3], moved[4][3];
  Lanes gradient[3][3];  ///< ∂u_i/∂x_k
  Lanes volume;

  void gather(const Body& body, std::span<const double> u, std::size_t first) {
    const ElementBatch row = in_a_row(first, body.mesh.element_count());
    kacanov::gather(body.mesh, row, body.mesh.coordinates, x);
    kacanov::gather(body.mesh, row, u, moved);
  }

  void work_out() {
    for (std::size_t lane = 0; lane < batch_size; ++lane) {
      double j[3][3], d[3][3], h[3][3];  // j, d: along the edges from the first corner
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          j[i][k] = x[k + 1][i][lane] - x[0][i][lane];
          d[i][k] = moved[k + 1][i][lane] - moved[0][i][lane];
        }
      volume[lane] = map_gradient(j, d, h) / 6.0;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) gradient[i][k][lane] = h[i][k];
    }
  }

  Vector3 middle_of(std::size_t lane) const {
    Vector3 middle;
    for (std::size_t i = 0; i < 3; ++i)
      middle[i] = 0.25 * (x[0][i][lane] + x[1][i][lane] + x[2][i][lane] + x[3][i][lane]);
    return middle;
  }
};

reference::Strain strain_of(const reference::Gradient& h) {
  reference::Strain s;
  s.trace = h[0][0] + h[1][1] + h[2][2];
  s.square = s.trace * s.trace;
  const double mean = s.trace / 3.0;
  s.dev = {h[0][0] - mean,
           h[1][1] - mean,
           h[2][2] - mean,
           0.5 * (h[0][1] + h[1][0]),
           0.5 * (h[1][2] + h[2][1]),
           0.5 * (h[2][0] + h[0][2])};
  return s;
}

/// Strain as used by a law: with means of tr ε around the corners if the law needs them.
class Strains {
 public:
  Strains(const Body& body, std::span<const double> u)
      : body_(body), means_(body, u, body.corner_dilatation) {}
  reference::Strain operator()(std::size_t element, const reference::Gradient& h) const {
    reference::Strain strain = strain_of(h);
    means_.put<elements::Tet4>(body_.law(element), element, 0, strain);
    return strain;
  }

 private:
  const Body& body_;
  reference::CornerDilatation means_;
};

/// Calls visit(element, batch, lane).
template <class Visit>
void for_each_element(const Body& body, std::span<const double> u, const Visit& visit) {
  const std::size_t elements = body.mesh.element_count();
  BatchState some;
  for (std::size_t first = 0; first < elements; first += batch_size) {
    some.gather(body, u, first);
    some.work_out();
    const std::size_t count = std::min(batch_size, elements - first);
    for (std::size_t lane = 0; lane < count; ++lane) visit(first + lane, some, lane);
  }
}

void fields(const Body& body, std::span<const double> u, const reference::ElementFields& out) {
  const bool moduli = !out.stress.empty() || !out.von_mises.empty() || !out.secant.empty();
  const Strains strains(body, u);
  for_each_element(body, u, [&](std::size_t e, const BatchState& some, std::size_t lane) {
    const reference::Gradient h = gradient_of(some.gradient, lane);
    const reference::Strain strain = strains(e, h);
    const Law& law = body.law(e);
    const double norm = strain.norm(), g = moduli ? law.secant(norm) : 0.0;
    if (!out.stress.empty()) {
      const reference::Sym tau = reference::stress(law, g, strain);
      std::copy(tau.begin(), tau.end(), &out.stress[6 * e]);
    }
    if (!out.von_mises.empty()) out.von_mises[e] = std::sqrt(1.5) * 2.0 * g * norm;
    if (!out.dev_strain.empty()) out.dev_strain[e] = norm;
    if (!out.secant.empty()) out.secant[e] = g;
    if (!out.plastic.empty()) out.plastic[e] = law.plastic(norm) ? 1 : 0;
    if (!out.strain.empty()) out.strain[e] = reference::largest_principal(h);
    if (!out.rotation.empty()) out.rotation[e] = reference::rotation_angle(h);
    if (!out.volume.empty()) out.volume[e] = some.volume[lane];
  });
}

void point_fields(const Body& body, std::span<const double> u, const reference::PointFields& out) {
  const Strains strains(body, u);
  for_each_element(body, u, [&](std::size_t e, const BatchState& some, std::size_t lane) {
    const reference::Strain strain = strains(e, gradient_of(some.gradient, lane));
    if (!out.stress.empty()) {
      const Law& law = body.law(e);
      const reference::Sym tau = reference::stress(law, law.secant(strain.norm()), strain);
      std::copy(tau.begin(), tau.end(), &out.stress[6 * e]);
    }
    for (std::size_t i = 0; i < 6 && !out.strain.empty(); ++i)
      out.strain[6 * e + i] = strain.dev[i] + (i < 3 ? strain.trace / 3.0 : 0.0);
    if (!out.volume.empty()) out.volume[e] = some.volume[lane];
    if (!out.position.empty()) out.position[e] = some.middle_of(lane);
  });
}

double energy(const Body& body, std::span<const double> u) {
  double sum = 0.0;
  const Strains strains(body, u);
  for_each_element(body, u, [&](std::size_t e, const BatchState& some, std::size_t lane) {
    const reference::Strain strain = strains(e, gradient_of(some.gradient, lane));
    const Law& law = body.law(e);
    sum += some.volume[lane] * (0.5 * law.bulk * strain.square + 2.0 * law.energy(strain.norm()));
  });
  return sum;
}

void volumes(const Body& body, std::span<double> volume) {
  for_each_element(body, body.mesh.coordinates, [&](std::size_t e, const BatchState& some, std::size_t lane) {
    volume[e] = some.volume[lane];
  });
}

}  // namespace
}  // namespace kacanov::tet4

const kacanov::FieldLoops kacanov::tet4_loops{tet4::fields, tet4::point_fields, tet4::energy, tet4::volumes};

namespace kacanov {
namespace {

using reference::CornerDilatation;

using simd::RowPoint, simd::RowStrain;

/// A batch of elements with values at their points: 140 ns per tet10 against 610 ns in the reference.
template <class Element>
struct Row {
  std::size_t first = 0, count = 0;
  Lanes x[Element::nodes][3];
  RowPoint at[Element::points];
  Lanes weight[Element::points];  ///< volumes of the points
  Lanes square[Element::points];  ///< of the trace, as used in the energy
  Lanes volume;
  const Law* law[batch_size];
  const simd::RowLoops<Element::nodes>& loops = simd::row_loops<Element::nodes>({});

  /// `means`: null if strains are not needed.
  void work_out(const Body& body, std::span<const double> u, const CornerDilatation* means) {
    const std::size_t elements = body.mesh.element_count();
    const ElementBatch row = in_a_row(first, elements);
    count = std::min(batch_size, elements - first);
    bool mean_dilatation = false;
    for (std::size_t lane = 0; lane < batch_size; ++lane) {
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
      for (std::size_t lane = 0; lane < batch_size; ++lane) {
        weight[q][lane] = Element::weight * at[q].det[lane];
        volume[lane] += weight[q][lane];
      }
    }
    if (means == nullptr) return;
    if (mean_dilatation && Element::mean_dilatation) average_traces();
    for (std::size_t q = 0; q < Element::points; ++q)
      for (std::size_t lane = 0; lane < batch_size; ++lane)
        square[q][lane] = at[q].strain.trace[lane] * at[q].strain.trace[lane];
    if (mean_dilatation && Element::corner_dilatation) put_means(row, *means);
  }

 private:
  void average_traces() {
    Lanes mean{};
    for (std::size_t q = 0; q < Element::points; ++q)
      for (std::size_t lane = 0; lane < batch_size; ++lane)
        mean[lane] += weight[q][lane] * at[q].strain.trace[lane];
    for (std::size_t lane = 0; lane < batch_size; ++lane)
      if (law[lane]->mean_dilatation)
        for (RowPoint& point : at) point.strain.trace[lane] = mean[lane] / volume[lane];
  }

  void put_means(const ElementBatch& row, const CornerDilatation& means) {
    for (std::size_t lane = 0; lane < batch_size; ++lane) {
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
  for (; row.first < body.mesh.element_count(); row.first += batch_size) {
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
  for (std::size_t lane = 0; lane < batch_size; ++lane) g[lane] = row.law[lane]->secant(norm[lane]);
  return g;
}

void add(Lanes& sum, const Lanes& weight, const Lanes& value) {
  for (std::size_t lane = 0; lane < batch_size; ++lane) sum[lane] += weight[lane] * value[lane];
}

template <class Element>
void put(const Row<Element>& row, const Lanes& sum, std::span<double> out) {
  for (std::size_t lane = 0; lane < row.count && !out.empty(); ++lane)
    out[row.first + lane] = sum[lane] / row.volume[lane];
}

/// Writes means over the points.
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
    for (std::size_t lane = 0; lane < batch_size; ++lane) {
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

/// Writes maxima over the points.
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
      for (std::size_t lane = 0; lane < batch_size; ++lane)
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
