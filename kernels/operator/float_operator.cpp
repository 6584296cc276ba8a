// SPDX-License-Identifier: BSD-3-Clause
// The single precision operator behind its interface.
#include <kacanov/float_operator.hpp>

#include <vector>

#include "operator/checks.hpp"
#include "operator/engine.hpp"

namespace kacanov {

struct FloatOperator::Implementation {
  Engine<float> engine;

  Implementation(const Body& body, const OperatorOptions& options)
      : engine(checked(body, options), options.threads, simd::choose_instruction_set(options.instruction_set),
               options.early) {}

  double apply(std::span<const float> x, std::span<float> y, bool with_dot,
               const WhenEarly& when_early) const {
    expect_size(x.size(), engine.unknowns(), "x");
    expect_size(y.size(), engine.unknowns(), "y");
    return engine.apply(x.data(), y.data(), 1, with_dot, when_early);
  }
};

FloatOperator::FloatOperator(const Body& body, const OperatorOptions& options)
    : impl_(std::make_unique<Implementation>(body, options)) {}

FloatOperator::~FloatOperator() = default;
FloatOperator::FloatOperator(FloatOperator&&) noexcept = default;
FloatOperator& FloatOperator::operator=(FloatOperator&&) noexcept = default;

std::size_t FloatOperator::unknowns() const noexcept { return impl_->engine.unknowns(); }

void FloatOperator::set_secant(std::span<const double> g) {
  expect_size(g.size(), impl_->engine.points(), "g");
  impl_->engine.set_secant(g);
}

void FloatOperator::apply(std::span<const float> x, std::span<float> y, const WhenEarly& when_early) const {
  impl_->apply(x, y, false, when_early);
}

double FloatOperator::apply_dot(std::span<const float> x, std::span<float> y) const {
  return impl_->apply(x, y, true, {});
}

void FloatOperator::apply_many(std::span<const float> x, std::span<float> y, int vectors) const {
  impl_->engine.apply_many(x, y, vectors);
}

void FloatOperator::secant(std::span<double> g) const {
  expect_size(g.size(), impl_->engine.points(), "g");
  impl_->engine.get_secant(g);
}

void FloatOperator::diagonal(std::span<float> d) const {
  expect_size(d.size(), unknowns(), "d");
  impl_->engine.diagonal(d);
}

void FloatOperator::block_diagonal(std::span<float> blocks) const {
  expect_size(blocks.size(), unknowns() * impl_->engine.dim(), "blocks");
  impl_->engine.block_diagonal(blocks);
}

std::string_view FloatOperator::instruction_set() const noexcept {
  return simd::name(impl_->engine.instruction_set());
}

std::size_t FloatOperator::bytes() const noexcept { return impl_->engine.bytes(); }

}  // namespace kacanov
