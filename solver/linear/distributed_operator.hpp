// SPDX-License-Identifier: BSD-3-Clause
// The operator over all ranks: each rank applies its elements, and shared entries are summed.
#pragma once

#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include <kacanov/operator.hpp>
#include <kacanov/part.hpp>
#include <kacanov/scatterer.hpp>
#include "linear/springs.hpp"
#include "operator/nodal_pressure.hpp"

namespace kacanov {

/// The operators of all ranks' elements plus the springs. Input and output vectors have the part's unknowns
/// and are consistent (see Part); g has elements × points of the part. Units are those of the problem.
/// Non-const members and diagonal() are collective.
class DistributedOperator {
 public:
  /// Sets up the elastic operator. Collective. `part` must outlive it; threads and instruction set as in
  /// OperatorOptions.
  DistributedOperator(const Part& part, int threads, const std::string& instruction_set)
      : part_(&part),
        local_(part.body(), OperatorOptions{threads, instruction_set, part.node_map.shared}),
        sum_(part.node_map, part.dim()) {
    if (part.node_map.ranks > 1 && !corner_moduli(part.body()).empty())
      local_.set_corner_sum(CornerSum<double>(corner_means(part.body()), part.node_map));
  }

  /// y = B(g) x. Communication of shared entries overlaps with the interior computation. Returns this rank's
  /// share of xᵀ y.
  double apply(std::span<const double> x, std::span<double> y) {
    return apply_and_sum(x, y, [&](const OnInterfaceReady& send) { return local_.apply_dot(x, y, send); });
  }
  /// y = B_T x with the last frozen tangent; otherwise like apply().
  double apply_tangent(std::span<const double> x, std::span<double> y) {
    return apply_and_sum(x, y,
                         [&](const OnInterfaceReady& send) { return local_.apply_tangent_dot(x, y, send); });
  }
  /// Sets a callback that runs on all ranks after every application. It may throw to abort the enclosing
  /// loops.
  void watch(std::function<void()> watcher) { watcher_ = std::move(watcher); }

  /// Plane stress: sets the free (thermal) strain of each element for all quantities computed from a
  /// displacement. Forces and energy then include the elastic thermal part, which the load also contains.
  /// Empty: no free strain.
  void set_free_strain(std::span<const double> of_element) {
    if (of_element.empty() && free_force_.empty()) return;
    local_.set_free_strain(of_element);
    Body body = part_->body();
    body.free_strain = of_element;
    free_force_.resize(of_element.empty() ? 0 : part_->unknowns());
    free_energy_ = of_element.empty() ? 0.0 : reference::free_force(body, free_force_);
  }
  /// Freezes g at u.
  void update(std::span<const double> u) { local_.update(u); }
  /// Freezes the tangent, and g, at u.
  void update_tangent(std::span<const double> u) { local_.update_tangent(u); }
  /// Frees the tangent's memory until the next update_tangent().
  void forget_tangent() noexcept { local_.forget_tangent(); }
  void set_secant(std::span<const double> g) { local_.set_secant(g); }
  /// Computes the internal force of the nonlinear law; counts as one application.
  void residual(std::span<const double> u, std::span<double> f) {
    local_.residual(u, f);
    add_free_force(u, f);
    part_->node_map.sum(f, part_->dim());
    add_spring_response(*part_, u, f);
    ++applications_;
  }
  /// The same, and freezes g at u in the same pass. Returns the stored energy over all ranks.
  double residual_energy_update(std::span<const double> u, std::span<double> f) {
    double energy = local_.residual_energy_update(u, f) + spring_energy(*part_, u);
    energy += add_free_force(u, f);
    part_->node_map.sum(f, part_->dim());
    add_spring_response(*part_, u, f);
    ++applications_;
    return part_->node_map.sum_all(energy);
  }
  double energy(std::span<const double> u) {
    return part_->node_map.sum_all(local_.energy(u) + spring_energy(*part_, u) + add_free_force(u, {}));
  }

  /// Returns the diagonal of B(g), consistent; it serves as a stiffness scale, so single precision suffices.
  std::vector<float> diagonal() const {
    std::vector<double> exact(local_.unknowns());
    local_.diagonal(exact);
    part_->node_map.sum(exact, part_->dim());
    add_spring_diagonal(*part_, exact);
    return {exact.begin(), exact.end()};
  }

  const Operator& local() const noexcept { return local_; }
  std::uint64_t applications() const noexcept { return applications_; }

 private:
  /// Calls work(send), which calls `send` once shared entries are complete, and sums them in y.
  template <class Work>
  double apply_and_sum(std::span<const double> x, std::span<double> y, const Work& work) {
    OnInterfaceReady send;
    if (part_->node_map.ranks > 1) send = [&, this] { sum_.start_sum(y); };
    double share = work(send);
    sum_.finish_sum(y);
    share += add_spring_response(*part_, x, y);
    ++applications_;
    if (watcher_) watcher_();
    return share;
  }

  /// Adds the free-strain force of this rank's elements to `f`, which may be empty; returns the energy
  /// contribution.
  double add_free_force(std::span<const double> u, std::span<double> f) const {
    if (free_force_.empty()) return 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) f[i] += free_force_[i];
    return std::inner_product(u.begin(), u.end(), free_force_.begin(), -free_energy_);
  }

  const Part* part_;
  Operator local_;
  std::vector<double> free_force_;
  double free_energy_ = 0.0;
  Scatterer<double> sum_;
  std::uint64_t applications_ = 0;
  std::function<void()> watcher_;
};

}  // namespace kacanov
