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
  if (from.type != body.mesh.type || from.plane != body.mesh.plane || from.unknowns != body.unknowns() ||
      from.points != body.secant_count())
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
  return data_->unknowns;
}

template <class Real>
void BasicOperator<Real>::set_corner_sum(std::function<void(std::span<Real>)> sum) {
  data_->sum_corners = std::move(sum);
  data_->weigh_corners();
}

template <class Real>
void BasicOperator<Real>::set_free_strain(std::span<const double> of_element) {
  Data& data = *data_;
  if (data.plane != PlaneState::stress) throw std::logic_error("free strain is for plane stress");
  const std::size_t each = points_per_element(data.type);
  if (of_element.empty()) return Aligned<Real>().swap(data.free_strain);
  expect_size(of_element.size() * each, data.points, "free strain");
  std::vector<double> of_point(data.points);
  for (std::size_t k = 0; k < of_point.size(); ++k) of_point[k] = of_element[k / each];
  data.by_slot(of_point, data.free_strain);
}

template <class Real>
void BasicOperator<Real>::update(std::span<const Real> u) {
  expect_size(u.size(), unknowns(), "u");
  data_->nonlinear(u.data(), nullptr, {.keep_secant = true});
}

template <class Real>
void BasicOperator<Real>::secant(std::span<double> g) const {
  const Data& data = *data_;
  expect_size(g.size(), data.points, "g");
  for (std::size_t slot = 0; slot < data.secant.size(); ++slot)
    if (const std::int32_t point = data.layout.element_point[slot]; point >= 0)
      g[point] = static_cast<double>(data.secant[slot]);
}

template <class Real>
void BasicOperator<Real>::set_secant(std::span<const double> g) {
  expect_size(g.size(), data_->points, "g");
  data_->detach_tangent();
  for (std::size_t slot = 0; slot < data_->secant.size(); ++slot)
    if (const std::int32_t point = data_->layout.element_point[slot]; point >= 0)
      data_->secant[slot] = static_cast<Real>(g[point]);
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
  if (!data_->has_tangent) throw std::logic_error("apply_tangent_many before update_tangent");
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
  if (!data_->has_tangent) throw std::logic_error("apply_tangent before update_tangent");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  data_->apply_tangent(x.data(), y.data(), 1, false, on_interface_ready);
}

template <class Real>
double BasicOperator<Real>::apply_tangent_dot(std::span<const Real> x, std::span<Real> y,
                                              const OnInterfaceReady& on_interface_ready) {
  if (!data_->has_tangent) throw std::logic_error("apply_tangent_dot before update_tangent");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  return data_->apply_tangent(x.data(), y.data(), 1, true, on_interface_ready);
}

template <class Real>
void BasicOperator<Real>::take_tangent(const BasicOperator<double>& from) {
  const auto& other = *from.data_;
  Data& data = *data_;
  if (!other.has_tangent) throw std::logic_error("take_tangent before update_tangent");
  expect_size(other.points, data.points, "from");
  std::vector<std::size_t> there(data.points);
  for (std::size_t slot = 0; slot < other.secant.size(); ++slot)
    if (const std::int32_t point = other.layout.element_point[slot]; point >= 0) there[point] = slot;
  const auto& g = other.tangent_secant.empty() ? other.secant : other.tangent_secant;
  data.has_tangent = true;
  data.tangent.assign(simd::tangent_floats * data.secant.size(), 0.0F);
  data.tangent_secant.assign(data.secant.size(), Real(0));
  // Position in the tangent; the number of lanes differs between the precisions.
  const auto place = [](std::size_t slot, std::size_t lanes) {
    return simd::tangent_floats * (slot - slot % lanes) + slot % lanes;
  };
  const std::size_t mine = data.layout.lanes, its = other.layout.lanes;
  for (std::size_t slot = 0; slot < data.secant.size(); ++slot) {
    const std::int32_t point = data.layout.element_point[slot];
    if (point < 0) continue;
    const std::size_t source = there[point];
    data.tangent_secant[slot] = static_cast<Real>(g[source]);
    for (std::size_t k = 0; k < simd::tangent_floats; ++k)
      data.tangent[place(slot, mine) + k * mine] = other.tangent[place(source, its) + k * its];
  }
}

template <class Real>
void BasicOperator<Real>::forget_tangent() noexcept {
  data_->has_tangent = false;
  Aligned<float>().swap(data_->tangent);  // assigning {} would keep the memory
  Aligned<Real>().swap(data_->tangent_secant);
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
  expect_plane_strain(data_->plane);
  Data& data = *data_;
  expect_size(u.size(), unknowns(), "u");
  expect_size(x.size(), data.points, "x");
  data.strain.resize(data.secant.size());
  data.nonlinear(u.data(), nullptr, {}, {.strain = data.strain.data()});
  for (std::size_t slot = 0; slot < data.strain.size(); ++slot)
    if (const std::int32_t point = data.layout.element_point[slot]; point >= 0)
      x[point] = static_cast<double>(data.strain[slot]);
}

template <class Real>
void BasicOperator<Real>::update_tangent(std::span<const Real> u, const PointModuli& moduli) {
  expect_plane_strain(data_->plane);
  Data& data = *data_;
  expect_size(u.size(), unknowns(), "u");
  expect_size(moduli.secant.size(), data.points, "moduli.secant");
  expect_size(moduli.derivative.size(), data.points, "moduli.derivative");
  const simd::Outside<Real> outside{.secant = data.by_slot(moduli.secant, data.outside_secant),
                                    .slope = data.by_slot(moduli.derivative, data.outside_slope)};
  data.nonlinear(u.data(), nullptr, {.keep_secant = true, .keep_tangent = true}, outside);
}

template <class Real>
double BasicOperator<Real>::residual_energy(std::span<const Real> u, const PointModuli& moduli,
                                            std::span<Real> f) {
  expect_plane_strain(data_->plane);
  Data& data = *data_;
  expect_size(u.size(), unknowns(), "u");
  if (!f.empty()) expect_size(f.size(), unknowns(), "f");
  expect_size(moduli.secant.size(), data.points, "moduli.secant");
  if (!moduli.energy.empty()) expect_size(moduli.energy.size(), data.points, "moduli.energy");
  const simd::Outside<Real> outside{.secant = data.by_slot(moduli.secant, data.outside_secant),
                                    .energy = data.by_slot(moduli.energy, data.outside_energy)};
  const double energy = data.nonlinear(u.data(), f.empty() ? nullptr : f.data(), {}, outside);
  return moduli.energy.empty() ? 0.0 : energy;
}

template <class Real>
std::string_view BasicOperator<Real>::instruction_set() const noexcept {
  return simd::name(data_->set);
}

template <class Real>
std::size_t BasicOperator<Real>::bytes() const noexcept {
  const Data& data = *data_;
  std::size_t sum = data.layout.bytes() + data.corners.bytes() +
                    (data.weight.size() + data.change.size() + data.mean.size()) * sizeof(Real) +
                    (data.corner_bulk.size() + data.corner_volume.size()) * sizeof(double) +
                    (data.coordinates.size() + data.secant.size() + data.tangent_secant.size() +
                     data.strain.size() + data.free_strain.size() + data.outside_secant.size() +
                     data.outside_slope.size() + data.outside_energy.size()) *
                        sizeof(Real) +
                    data.tangent.size() * sizeof(float);
  for (const auto& scratch : data.scratch)
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
