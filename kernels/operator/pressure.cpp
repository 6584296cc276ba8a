// SPDX-License-Identifier: BSD-3-Clause
// Parts of an operator that averages tr ε around corners: deviator, volume changes, forces of pressures.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "operator/checks.hpp"
#include "operator/passes.hpp"

namespace kacanov {
namespace {

void expect_pressures(bool averages, const char* member) {
  if (!averages) throw std::logic_error(std::string(member) + " where nothing is averaged");
}

}  // namespace

template <class Real>
std::size_t BasicOperator<Real>::pressures() const noexcept {
  return data_->corners.entries;
}

template <class Real>
void BasicOperator<Real>::apply_deviator(std::span<const Real> x, std::span<const Real> p, std::span<Real> y,
                                         const WhenEarly& when_early) {
  expect_pressures(data_->averages(), "apply_deviator");
  expect_size(x.size(), unknowns(), "x");
  expect_size(y.size(), unknowns(), "y");
  ++data_->applications;
  if (p.empty()) return data_->apply_deviator(x.data(), y.data(), when_early);
  expect_size(p.size(), pressures(), "p");
  data_->apply_pressure(x.data(), p.data(), y.data(), when_early);
}

template <class Real>
void BasicOperator<Real>::pressure_force(std::span<const Real> p, std::span<Real> y,
                                         const WhenEarly& when_early) {
  expect_pressures(data_->averages(), "pressure_force");
  expect_size(p.size(), pressures(), "p");
  expect_size(y.size(), unknowns(), "y");
  data_->apply_pressure(nullptr, p.data(), y.data(), when_early);
}

template <class Real>
void BasicOperator<Real>::volume_change(std::span<const Real> x, std::span<Real> q) {
  expect_pressures(data_->averages(), "volume_change");
  expect_size(x.size(), unknowns(), "x");
  expect_size(q.size(), pressures(), "q");
  data_->find_changes(x.data(), 1);
  std::copy_n(data_->change.begin(), q.size(), q.begin());
}

template std::size_t BasicOperator<double>::pressures() const noexcept;
template std::size_t BasicOperator<float>::pressures() const noexcept;
template void BasicOperator<double>::apply_deviator(std::span<const double>, std::span<const double>,
                                                    std::span<double>, const WhenEarly&);
template void BasicOperator<float>::apply_deviator(std::span<const float>, std::span<const float>,
                                                   std::span<float>, const WhenEarly&);
template void BasicOperator<double>::pressure_force(std::span<const double>, std::span<double>,
                                                    const WhenEarly&);
template void BasicOperator<float>::pressure_force(std::span<const float>, std::span<float>,
                                                   const WhenEarly&);
template void BasicOperator<double>::volume_change(std::span<const double>, std::span<double>);
template void BasicOperator<float>::volume_change(std::span<const float>, std::span<float>);

}  // namespace kacanov
