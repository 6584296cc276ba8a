// SPDX-License-Identifier: BSD-3-Clause
// The operator over all ranks: each applies its elements, the halo adds up shared nodes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include <kacanov/operator.hpp>
#include <kacanov/part.hpp>
#include <kacanov/scatterer.hpp>

namespace kacanov {

/// Input and output vectors are consistent (Part).
class DistributedOperator {
 public:
  DistributedOperator(const Part& part, int threads, const std::string& instruction_set)
      : part_(&part),
        local_(part.body(), OperatorOptions{threads, instruction_set, part.halo.shared}),
        sum_(part.halo, part.dim()) {}

  /// y = B(g) x, or B_T x between use_tangent(true) and use_tangent(false). Sums for shared nodes travel
  /// while the rest is worked out. Returns this rank's share of xᵀ y.
  double apply(std::span<const double> x, std::span<double> y) {
    WhenEarly send;
    if (part_->halo.ranks > 1) send = [&, this] { sum_.start_sum(y); };
    const double share = tangent_ ? local_.apply_tangent_dot(x, y, send) : local_.apply_dot(x, y, send);
    sum_.finish_sum(y);
    ++applications_;
    if (watcher_) watcher_();
    return share;
  }
  /// Called after every application, on all ranks alike. It may throw to leave whatever loops go on.
  void watch(std::function<void()> watcher) { watcher_ = std::move(watcher); }
  void use_tangent(bool on) noexcept { tangent_ = on; }
  bool tangent() const noexcept { return tangent_; }

  /// Freezes g (and the tangent, if in use) at ω.
  void update(std::span<const double> omega) {
    if (tangent_)
      local_.update_tangent(omega);
    else
      local_.update(omega);
  }
  /// Gives the tangent's memory back until the next update.
  void forget_tangent() noexcept { local_.forget_tangent(); }
  void set_secant(std::span<const double> g) { local_.set_secant(g); }
  /// Internal force of the true law; counts as an application.
  void residual(std::span<const double> omega, std::span<double> f) {
    local_.residual(omega, f);
    part_->halo.sum(f, part_->dim());
    ++applications_;
  }
  /// The same with the stored energy, which is returned, and g frozen at ω, in one pass.
  double residual_energy_update(std::span<const double> omega, std::span<double> f) {
    const double energy = local_.residual_energy_update(omega, f);
    part_->halo.sum(f, part_->dim());
    ++applications_;
    return part_->halo.sum_all(energy);
  }
  double energy(std::span<const double> omega) { return part_->halo.sum_all(local_.energy(omega)); }

  /// Diagonal of B(g), consistent: a measure of stiffness, so single precision does.
  std::vector<float> diagonal() const {
    std::vector<double> exact(local_.unknowns());
    local_.diagonal(exact);
    part_->halo.sum(exact, part_->dim());
    return {exact.begin(), exact.end()};
  }

  const Operator& local() const noexcept { return local_; }
  std::uint64_t applications() const noexcept { return applications_; }

 private:
  const Part* part_;
  Operator local_;
  Scatterer<double> sum_;
  bool tangent_ = false;
  std::uint64_t applications_ = 0;
  std::function<void()> watcher_;
};

}  // namespace kacanov
