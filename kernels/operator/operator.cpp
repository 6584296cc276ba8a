// SPDX-License-Identifier: BSD-3-Clause
// The operator's members: they check the arguments and call the threaded loops.
#include <kacanov/operator.hpp>

#include <stdexcept>
#include <utility>
#include <vector>

#include "operator/checks.hpp"
#include "operator/threaded_loops.hpp"

namespace kacanov {
namespace {

/// Calls some(done, step) in steps of 4, 2 or 1 vectors, as the loops process them.
template <class Some>
void in_steps(int vectors, const Some& some) {
  for (int done = 0; done < vectors;) {
    const int left = vectors - done, step = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    some(done, step);
    done += step;
  }
}

/// User-defined laws cannot be evaluated while the transverse strain of plane stress is sought, and only the
/// loops for plane strain and 3D support them.
void expect_plane_strain(PlaneState plane) {
  if (plane != PlaneState::strain)
    throw std::logic_error("laws of the caller's own are for plane strain and 3D");
}

}  // namespace

template <class Real>
BasicOperator<Real>::BasicOperator(const Body& body, const OperatorOptions& options)
    : data_(std::make_unique<Data>(checked(body, options), options, nullptr)) {}

template <class Real>
BasicOperator<Real>::BasicOperator(const Body& body, const OperatorOptions& options,
                                   const BasicOperator<double>& like) {
  const auto& from = *like.data_;
  if (from.mesh.type != body.mesh.type || from.mesh.plane != body.mesh.plane ||
      from.mesh.unknowns != body.unknowns() || from.mesh.points != body.secant_count())
    throw std::invalid_argument("like: expected an operator of the same mesh");
  check_options(body, options);
  check_laws(body);
  data_ = std::make_unique<Data>(body, options, &from.layout);
}

template <class Real>
BasicOperator<Real>::~BasicOperator() = default;
template <class Real>
BasicOperator<Real>::BasicOperator(BasicOperator&&) noexcept = default;
template <class Real>
BasicOperator<Real>& BasicOperator<Real>::operator=(BasicOperator&&) noexcept = default;

template <class Real>
std::size_t BasicOperator<Real>::unknowns() const noexcept {
  return data_->mesh.unknowns;
}

template <class Real>
void BasicOperator<Real>::set_corner_sum(std::function<void(std::span<Real>)> sum) {
  data_->nodal.sum = std::move(sum);
  data_->weigh_corners();
}

template <class Real>
void BasicOperator<Real>::set_free_strain(std::span<const double> of_element) {
  Data& data = *data_;
  if (data.mesh.plane != PlaneState::stress) throw std::logic_error("free strain is for plane stress");
  const std::size_t each = points_per_element(data.mesh.type);
  if (of_element.empty()) return Aligned<Real>().swap(data.values.free_strain);
  expect_size(of_element.size() * each, data.mesh.points, "free strain");
  std::vector<double> of_point(data.mesh.points);
  for (std::size_t k = 0; k < of_point.size(); ++k) of_point[k] = of_element[k / each];
  data.by_slot(of_point, data.values.free_strain);
}

template <class Real>
void BasicOperator<Real>::update(std::span<const Real> u) {
  expect_size(u.size(), unknowns(), "u");
  data_->nonlinear(u.data(), nullptr, {.keep_secant = true});
}

template <class Real>
void BasicOperator<Real>::secant(std::span<double> g) const {
  const Data& data = *data_;
  expect_size(g.size(), data.mesh.points, "g");
  data.layout.for_each_point([g, from = data.values.secant.data()](std::size_t slot, std::size_t point) {
    g[point] = static_cast<double>(from[slot]);
  });
}

template <class Real>
void BasicOperator<Real>::set_secant(std::span<const double> g) {
  Data& data = *data_;
  expect_size(g.size(), data.mesh.points, "g");
  data.detach_tangent();
  data.layout.for_each_point([g, to = data.values.secant.data()](std::size_t slot, std::size_t point) {
    to[slot] = static_cast<Real>(g[point]);
  });
}

template <class Real>
void BasicOperator<Real>::apply(std::span<const Real> x, std::span<Real> y,
                                const OnInterfaceReady& on_interface_ready) {
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  data_->apply(x.data(), y.data(), 1, false, on_interface_ready);
}

template <class Real>
double BasicOperator<Real>::apply_dot(std::span<const Real> x, std::span<Real> y,
                                      const OnInterfaceReady& on_interface_ready) {
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  return data_->apply(x.data(), y.data(), 1, true, on_interface_ready);
}

template <class Real>
void BasicOperator<Real>::apply_many(std::span<const Real> x, std::span<Real> y, int vectors) {
  if (vectors < 1) throw std::invalid_argument("vectors: expected at least 1");
  const std::size_t count = vectors;
  expect_size(x.size(), unknowns() * count, "x");
  expect_size(y.size(), unknowns() * count, "y");
  in_steps(vectors, [&](int done, int step) {
    const std::size_t offset = unknowns() * done;
    data_->apply(x.data() + offset, y.data() + offset, step, false);
  });
  data_->applications += count;
}

template <class Real>
void BasicOperator<Real>::apply_tangent_many(std::span<const Real> x, std::span<Real> y, int vectors) {
  if (!data_->tangent.present) throw std::logic_error("apply_tangent_many before update_tangent");
  if (vectors < 1) throw std::invalid_argument("vectors: expected at least 1");
  const std::size_t count = vectors;
  expect_size(x.size(), unknowns() * count, "x");
  expect_size(y.size(), unknowns() * count, "y");
  in_steps(vectors, [&](int done, int step) {
    const std::size_t offset = unknowns() * done;
    data_->apply_tangent(x.data() + offset, y.data() + offset, step, false);
  });
  data_->applications += count;
}

template <class Real>
void BasicOperator<Real>::update_tangent(std::span<const Real> u) {
  expect_size(u.size(), unknowns(), "u");
  data_->nonlinear(u.data(), nullptr, {.keep_secant = true, .keep_tangent = true});
}

template <class Real>
void BasicOperator<Real>::apply_tangent(std::span<const Real> x, std::span<Real> y,
                                        const OnInterfaceReady& on_interface_ready) {
  if (!data_->tangent.present) throw std::logic_error("apply_tangent before update_tangent");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  data_->apply_tangent(x.data(), y.data(), 1, false, on_interface_ready);
}

template <class Real>
double BasicOperator<Real>::apply_tangent_dot(std::span<const Real> x, std::span<Real> y,
                                              const OnInterfaceReady& on_interface_ready) {
  if (!data_->tangent.present) throw std::logic_error("apply_tangent_dot before update_tangent");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  return data_->apply_tangent(x.data(), y.data(), 1, true, on_interface_ready);
}

template <class Real>
void BasicOperator<Real>::take_tangent(const BasicOperator<double>& from) {
  const auto& other = *from.data_;
  Data& data = *data_;
  if (!other.tangent.present) throw std::logic_error("take_tangent before update_tangent");
  expect_size(other.mesh.points, data.mesh.points, "from");
  std::vector<std::size_t> there(data.mesh.points);
  other.layout.for_each_point([&](std::size_t slot, std::size_t point) { there[point] = slot; });
  const auto& g = other.tangent.secant.empty() ? other.values.secant : other.tangent.secant;
  data.tangent.present = true;
  data.tangent.floats.assign(simd::tangent_floats * data.values.secant.size(), 0.0F);
  data.tangent.secant.assign(data.values.secant.size(), Real(0));
  // Position in the tangent; the number of lanes differs between the precisions.
  const auto place = [](std::size_t slot, std::size_t lanes) {
    return simd::tangent_floats * (slot - slot % lanes) + slot % lanes;
  };
  const std::size_t mine = data.layout.lanes, its = other.layout.lanes;
  data.layout.for_each_point([&](std::size_t slot, std::size_t point) {
    const std::size_t source = there[point];
    data.tangent.secant[slot] = static_cast<Real>(g[source]);
    for (std::size_t k = 0; k < simd::tangent_floats; ++k)
      data.tangent.floats[place(slot, mine) + k * mine] = other.tangent.floats[place(source, its) + k * its];
  });
}

template <class Real>
void BasicOperator<Real>::forget_tangent() noexcept {
  data_->tangent.present = false;
  Aligned<float>().swap(data_->tangent.floats);  // assigning {} would keep the memory
  Aligned<Real>().swap(data_->tangent.secant);
}

template <class Real>
void BasicOperator<Real>::residual(std::span<const Real> u, std::span<Real> f) {
  expect_size(u.size(), unknowns(), "u");
  expect_size(f.size(), unknowns(), "f");
  data_->nonlinear(u.data(), f.data(), {});
}

template <class Real>
double BasicOperator<Real>::energy(std::span<const Real> u) {
  expect_size(u.size(), unknowns(), "u");
  return data_->nonlinear(u.data(), nullptr, {.sum_energy = true});
}

template <class Real>
double BasicOperator<Real>::residual_energy_update(std::span<const Real> u, std::span<Real> f) {
  expect_size(u.size(), unknowns(), "u");
  expect_size(f.size(), unknowns(), "f");
  return data_->nonlinear(u.data(), f.data(), {.keep_secant = true, .sum_energy = true});
}

template <class Real>
void BasicOperator<Real>::strain(std::span<const Real> u, std::span<double> x) {
  expect_plane_strain(data_->mesh.plane);
  Data& data = *data_;
  expect_size(u.size(), unknowns(), "u");
  expect_size(x.size(), data.mesh.points, "x");
  data.values.strain.resize(data.values.secant.size());
  data.nonlinear(u.data(), nullptr, {}, {.strain = data.values.strain.data()});
  data.layout.for_each_point([x, from = data.values.strain.data()](std::size_t slot, std::size_t point) {
    x[point] = static_cast<double>(from[slot]);
  });
}

template <class Real>
void BasicOperator<Real>::update_tangent(std::span<const Real> u, const PointModuli& moduli) {
  expect_plane_strain(data_->mesh.plane);
  Data& data = *data_;
  expect_size(u.size(), unknowns(), "u");
  expect_size(moduli.secant.size(), data.mesh.points, "moduli.secant");
  expect_size(moduli.derivative.size(), data.mesh.points, "moduli.derivative");
  const simd::Outside<Real> outside{.secant = data.by_slot(moduli.secant, data.values.outside_secant),
                                    .slope = data.by_slot(moduli.derivative, data.values.outside_slope)};
  data.nonlinear(u.data(), nullptr, {.keep_secant = true, .keep_tangent = true}, outside);
}

template <class Real>
double BasicOperator<Real>::residual_energy(std::span<const Real> u, const PointModuli& moduli,
                                            std::span<Real> f) {
  expect_plane_strain(data_->mesh.plane);
  Data& data = *data_;
  expect_size(u.size(), unknowns(), "u");
  if (!f.empty()) expect_size(f.size(), unknowns(), "f");
  expect_size(moduli.secant.size(), data.mesh.points, "moduli.secant");
  if (!moduli.energy.empty()) expect_size(moduli.energy.size(), data.mesh.points, "moduli.energy");
  const simd::Outside<Real> outside{.secant = data.by_slot(moduli.secant, data.values.outside_secant),
                                    .energy = data.by_slot(moduli.energy, data.values.outside_energy)};
  const double energy = data.nonlinear(u.data(), f.empty() ? nullptr : f.data(), {}, outside);
  return moduli.energy.empty() ? 0.0 : energy;
}

template <class Real>
std::string_view BasicOperator<Real>::instruction_set() const noexcept {
  return simd::name(data_->machine.set);
}

template <class Real>
std::size_t BasicOperator<Real>::bytes() const noexcept {
  const Data& data = *data_;
  std::size_t sum =
      data.layout.bytes() + data.nodal.corners.bytes() +
      (data.nodal.weight.size() + data.nodal.change.size() + data.nodal.mean.size()) * sizeof(Real) +
      (data.nodal.bulk.size() + data.nodal.volume.size()) * sizeof(double) +
      (data.coordinates.size() + data.values.secant.size() + data.tangent.secant.size() +
       data.values.strain.size() + data.values.free_strain.size() + data.values.outside_secant.size() +
       data.values.outside_slope.size() + data.values.outside_energy.size()) *
          sizeof(Real) +
      data.tangent.floats.size() * sizeof(float);
  for (const auto& scratch : data.workspace.of_thread)
    sum += (scratch.u.size() + scratch.f.size() + scratch.sums.size()) * sizeof(Real);
  return sum;
}

template <class Real>
std::uint64_t BasicOperator<Real>::applications() const noexcept {
  return data_->applications;
}

template class BasicOperator<double>;
template class BasicOperator<float>;

}  // namespace kacanov
