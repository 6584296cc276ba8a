// SPDX-License-Identifier: BSD-3-Clause
// The operator's members: what they are given is checked here, the work is that of the passes.
#include <kacanov/operator.hpp>

#include <stdexcept>

#include "operator/checks.hpp"
#include "operator/passes.hpp"

namespace kacanov {

template <class Real>
BasicOperator<Real>::BasicOperator(const Body& body, const OperatorOptions& options)
    : data_(std::make_unique<Data>(checked(body, options), options)) {}

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
void BasicOperator<Real>::apply(std::span<const Real> x, std::span<Real> y, const WhenEarly& when_early) {
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  data_->apply(x.data(), y.data(), 1, false, when_early);
}

template <class Real>
double BasicOperator<Real>::apply_dot(std::span<const Real> x, std::span<Real> y,
                                      const WhenEarly& when_early) {
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  return data_->apply(x.data(), y.data(), 1, true, when_early);
}

template <class Real>
void BasicOperator<Real>::apply_many(std::span<const Real> x, std::span<Real> y, int vectors) {
  if (vectors < 1) throw std::invalid_argument("vectors: expected at least 1");
  const std::size_t count = vectors;
  expect_size(x.size(), unknowns() * count, "x");
  expect_size(y.size(), unknowns() * count, "y");
  for (int done = 0; done < vectors;) {
    const int left = vectors - done, step = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    const std::size_t offset = unknowns() * done;
    data_->apply(x.data() + offset, y.data() + offset, step, false);
    done += step;
  }
  data_->applications += count;
}

template <class Real>
void BasicOperator<Real>::update_tangent(std::span<const Real> u) {
  expect_size(u.size(), unknowns(), "u");
  data_->nonlinear(u.data(), nullptr, {.keep_secant = true, .keep_tangent = true});
}

template <class Real>
void BasicOperator<Real>::apply_tangent(std::span<const Real> x, std::span<Real> y,
                                        const WhenEarly& when_early) {
  if (data_->tangent.empty()) throw std::logic_error("apply_tangent before update_tangent");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  data_->apply_tangent(x.data(), y.data(), false, when_early);
}

template <class Real>
double BasicOperator<Real>::apply_tangent_dot(std::span<const Real> x, std::span<Real> y,
                                              const WhenEarly& when_early) {
  if (data_->tangent.empty()) throw std::logic_error("apply_tangent_dot before update_tangent");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  return data_->apply_tangent(x.data(), y.data(), true, when_early);
}

template <class Real>
void BasicOperator<Real>::forget_tangent() noexcept {
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
std::string_view BasicOperator<Real>::instruction_set() const noexcept {
  return simd::name(data_->set);
}

template <class Real>
std::size_t BasicOperator<Real>::bytes() const noexcept {
  const Data& data = *data_;
  std::size_t sum =
      data.layout.bytes() +
      (data.coordinates.size() + data.secant.size() + data.tangent_secant.size()) * sizeof(Real) +
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
