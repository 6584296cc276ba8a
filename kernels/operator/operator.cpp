// SPDX-License-Identifier: BSD-3-Clause
// The operator behind its interface: what it is given is checked here, the work is the engine's.
#include <kacanov/operator.hpp>

#include <stdexcept>
#include <utility>
#include <vector>

#include "operator/checks.hpp"
#include "operator/engine.hpp"

namespace kacanov {
struct Operator::Implementation {
  Engine<double> engine;
  std::uint64_t applications = 0;

  Implementation(const Body& body, const OperatorOptions& options)
      : engine(checked(body, options), options.threads, simd::choose_instruction_set(options.instruction_set),
               options.early) {}

  void expect_vector(std::size_t size) const { expect_size(size, engine.unknowns(), "vector"); }

  double apply_tangent(std::span<const double> x, std::span<double> y, bool with_dot,
                       const WhenEarly& when_early) {
    if (!engine.has_tangent()) throw std::logic_error("apply_tangent before update_tangent");
    expect_vector(x.size());
    expect_vector(y.size());
    ++applications;
    return engine.apply_tangent(x.data(), y.data(), with_dot, when_early);
  }
};

Operator::Operator(const Body& body, const OperatorOptions& options)
    : impl_(std::make_unique<Implementation>(body, options)) {}

Operator::~Operator() = default;
Operator::Operator(Operator&&) noexcept = default;
Operator& Operator::operator=(Operator&&) noexcept = default;

std::size_t Operator::unknowns() const noexcept { return impl_->engine.unknowns(); }

void Operator::update(std::span<const double> omega) {
  impl_->expect_vector(omega.size());
  impl_->engine.nonlinear(omega.data(), nullptr, {.keep_secant = true});
}

void Operator::secant(std::span<double> g) const {
  expect_size(g.size(), impl_->engine.points(), "g");
  impl_->engine.get_secant(g);
}

void Operator::set_secant(std::span<const double> g) {
  expect_size(g.size(), impl_->engine.points(), "g");
  impl_->engine.set_secant(g);
}

void Operator::apply(std::span<const double> x, std::span<double> y) const {
  impl_->expect_vector(x.size());
  impl_->expect_vector(y.size());
  ++impl_->applications;
  impl_->engine.apply(x.data(), y.data(), 1, false);
}

double Operator::apply_dot(std::span<const double> x, std::span<double> y,
                           const WhenEarly& when_early) const {
  impl_->expect_vector(x.size());
  impl_->expect_vector(y.size());
  ++impl_->applications;
  return impl_->engine.apply(x.data(), y.data(), 1, true, when_early);
}

void Operator::apply_many(std::span<const double> x, std::span<double> y, int vectors) const {
  impl_->engine.apply_many(x, y, vectors);
  impl_->applications += static_cast<std::uint64_t>(vectors);
}

void Operator::update_tangent(std::span<const double> omega) {
  impl_->expect_vector(omega.size());
  impl_->engine.nonlinear(omega.data(), nullptr, {.keep_secant = true, .keep_tangent = true});
}

void Operator::apply_tangent(std::span<const double> x, std::span<double> y) const {
  impl_->apply_tangent(x, y, false, {});
}

double Operator::apply_tangent_dot(std::span<const double> x, std::span<double> y,
                                   const WhenEarly& when_early) const {
  return impl_->apply_tangent(x, y, true, when_early);
}

void Operator::forget_tangent() noexcept { impl_->engine.forget_tangent(); }

void Operator::diagonal(std::span<double> d) const {
  impl_->expect_vector(d.size());
  impl_->engine.diagonal(d);
}

void Operator::block_diagonal(std::span<double> blocks) const {
  expect_size(blocks.size(), unknowns() * impl_->engine.dim(), "blocks");
  impl_->engine.block_diagonal(blocks);
}

void Operator::residual(std::span<const double> omega, std::span<double> f) const {
  impl_->expect_vector(omega.size());
  impl_->expect_vector(f.size());
  std::as_const(impl_->engine).nonlinear(omega.data(), f.data(), false);
}

double Operator::energy(std::span<const double> omega) const {
  impl_->expect_vector(omega.size());
  return std::as_const(impl_->engine).nonlinear(omega.data(), nullptr, true);
}

double Operator::residual_energy_update(std::span<const double> omega, std::span<double> f) {
  impl_->expect_vector(omega.size());
  impl_->expect_vector(f.size());
  return impl_->engine.nonlinear(omega.data(), f.data(), {.keep_secant = true, .sum_energy = true});
}

std::string_view Operator::instruction_set() const noexcept {
  return simd::name(impl_->engine.instruction_set());
}

std::size_t Operator::bytes() const noexcept { return impl_->engine.bytes(); }

std::uint64_t Operator::applications() const noexcept { return impl_->applications; }

}  // namespace kacanov
