// SPDX-License-Identifier: BSD-3-Clause
// The operator in single precision, for preconditioners: y = B(g) x and its diagonal.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include <kacanov/operator.hpp>

namespace kacanov {

/// As Operator, with vectors, coordinates (relative to the middle of each block) and g in single precision.
/// Relative error about 1e-6 on well-shaped elements. Throws std::invalid_argument on bad input.
class FloatOperator {
 public:
  explicit FloatOperator(const Body& body, const OperatorOptions& options = {});
  ~FloatOperator();
  FloatOperator(FloatOperator&&) noexcept;
  FloatOperator& operator=(FloatOperator&&) noexcept;

  std::size_t unknowns() const noexcept;
  /// Frozen g, elements × points in the caller's order, as Operator::secant hands it out. Starts as g = mu.
  void set_secant(std::span<const double> g);
  /// y = B(g) x (overwrites y).
  void apply(std::span<const float> x, std::span<float> y, const WhenEarly& when_early = {}) const;
  /// y = B(g) x and returns xᵀ y, summed in double precision.
  double apply_dot(std::span<const float> x, std::span<float> y) const;
  /// As Operator::apply_many.
  void apply_many(std::span<const float> x, std::span<float> y, int vectors) const;
  /// The g set last, rounded.
  void secant(std::span<double> g) const;
  void diagonal(std::span<float> d) const;
  /// dim × dim diagonal blocks of B, row-major: nodes × dim × dim.
  void block_diagonal(std::span<float> blocks) const;
  std::string_view instruction_set() const noexcept;
  /// Bytes this operator holds, index data included.
  std::size_t bytes() const noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kacanov
