// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy for bodies whose volume change is averaged.
#include "multigrid/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "multigrid/cg.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/mixed/schur_complement.hpp"
#include "multigrid/multigrid_body.hpp"
#include "multigrid/octree/coarse_space.hpp"
#include "operator/threads.hpp"

namespace kacanov {
namespace {

const SmootherWeights fine_smoothing = chebyshev_weights(4, 4.0);

struct Solves {
  PressureSteps between, at_ends;
};

/// A residual volume change is amplified by `contrast`, the largest k0/g, when the pressure is discarded: the
/// first and the last step of a cycle therefore solve more accurately than those between.
Solves round_corners(double contrast, double strength) {
  constexpr double range = 40.0;
  const double sigma = (range + 1.0) / (range - 1.0);
  const double wanted = std::acosh(std::max(1.0, 0.01 * contrast)) / std::acosh(sigma);
  const int ends = static_cast<int>(std::ceil(strength * std::clamp(wanted, 6.0, 30.0)));
  const int middle = (2 * ends + 2) / 3;
  return {{middle, 2.0 * middle + 2.0}, {ends, range}};
}

/// Pressures that alternate between elements move almost nothing, so that S has eigenvalues λ down to those
/// of C. A polynomial of degree 2√range reduces them so far that contrast λ times the residual is at most 1.
Solves over_elements(double contrast, double strength) {
  const double range = strength * strength * std::max(20.0, contrast / (2.0 * std::exp(1.0)));
  const int ends = static_cast<int>(std::ceil(2.0 * std::sqrt(range)));
  const int middle = static_cast<int>(std::ceil(2.0 * std::sqrt(ends)));
  return {{middle, 2.0 * middle + 2.0}, {ends, range}};
}

class MixedMultigrid final : public Multigrid::Hierarchy {
 public:
  MixedMultigrid(const MultigridBody& body, const MultigridOptions& options)
      : laws_(softened(body.body.laws)),
        body_(with_laws(body, laws_)),
        options_(options),
        pressures_(body_),
        fine_(body_, options, FinePart::deviator, &pressures_.means()),
        grids_(body_, options, &pressures_) {
    body_.like = nullptr;  // may be destroyed
  }

  /// With averages over elements, aggregates may be better.
  bool fits() const { return !averages_over_elements(body_.body) || grids_.fits(); }

  void setup(std::span<const double> g, const NodeSupports& supports) override {
    fine_.setup(g, supports);
    fine_.choose_smoother(1, 1.0);
    if (!schur_) prepare();
    scale_ = 1.0 / (fine_smoothing.damping * fine_.largest());
    schur_->setup(fine_.inverse(), scale_);
    grids_.setup(g, supports, fine_);
    contrast_ = pressure_contrast(body_, g);
    solves_ = solves();
  }

  void update(const NodeSupports& supports) override {
    const std::vector<float> inverse(fine_.inverse().begin(), fine_.inverse().end());
    const auto [blocks, space] = fine_.update(supports);
    schur_->update(inverse, fine_.inverse());
    grids_.update({blocks, space}, supports, fine_);
  }

  void secant(std::span<double> g) const override { fine_.secant(g); }

  void apply(std::span<const double> r, std::span<double> z, const Multigrid::Factors& factors) override {
    do {
      fine_.load(factors.in, r, b_);
      cycle(*this);
      fine_.store(factors.out, x_, z);
    } while (work(r, z) < 0.0 && strengthen());
  }

  int levels() const noexcept override { return 1 + grids_.levels(); }

  std::size_t bytes() const noexcept override {
    return fine_.bytes() + pressures_.bytes() + (schur_ ? schur_->bytes() : 0) + grids_.bytes() +
           (b_.size() + x_.size() + image_.size() + entries_.size()) * sizeof(float) +
           (p_.size() + change_.size() + rest_.size()) * sizeof(double);
  }

  // For cycle(): the grids are the last level.
  static bool is_last(std::size_t k) noexcept { return k == 1; }
  static int corrections(std::size_t) noexcept { return 1; }
  void smooth(std::size_t, bool before) {
    const std::size_t steps = fine_smoothing.weight.size();
    for (std::size_t i = 0; i < steps; ++i) {
      const std::size_t s = before ? i : steps - 1 - i;
      step(before && s == 0, s == 0 ? solves_.at_ends : solves_.between, fine_smoothing.weight[s]);
    }
  }
  /// Residual forces b − A x − Bᵀp, and residual volume changes S p − q of the last step.
  void restrict_residual(std::size_t) {
    fine_.residual(b_, x_, entries_, image_);
    schur_->multiply(p_, rest_);
    const double last = fine_smoothing.weight.back();
    each_in_shares(options_.threads, rest_.size(),
                   [&](std::size_t r) { rest_[r] = last * rest_[r] - wanted(r, last); });
    grids_.restrict_forces(image_, rest_);
  }
  void solve_last() { grids_.solve(); }
  void add_correction(std::size_t) {
    grids_.prolong(image_, p_);
    fine_.add_correction(image_, x_);
  }

 private:
  /// rᵀ z: negative if the cycle is not definite.
  double work(std::span<const double> r, std::span<const double> z) const {
    return body_.node_map->sum_all(
        sum_shares(options_.threads, body_.owned_unknowns(), [&](std::size_t begin, std::size_t end) {
          double sum = 0.0;
          for (std::size_t i = begin; i < end; ++i) sum += r[i] * z[i];
          return sum;
        }));
  }

  Solves solves() const {
    return (averages_over_elements(body_.body) ? over_elements : round_corners)(contrast_, strength_);
  }

  /// Solves with S more accurately from now on; returns false at the limit.
  bool strengthen() {
    if (strength_ > 3.0) return false;
    strength_ *= 1.5;
    solves_ = solves();
    return true;
  }

  /// Data that depend only on the mesh.
  void prepare() {
    schur_.emplace(body_, pressures_, options_.threads);
    for (auto* v : {&b_, &x_, &image_}) v->resize(body_.unknowns());
    entries_.resize(pressures_.means().size());
    p_.resize(schur_->size());
    for (auto* v : {&change_, &rest_}) v->resize(pressures_.rows());
  }

  /// One Braess–Sarazin step: t = x + ωÂ⁻¹(b − A x); solve (ω (S − C) + C) p = B t for p; x = t − ωÂ⁻¹Bᵀ p.
  void step(bool from_zero, const PressureSteps& with, double weight) {
    const auto scale = static_cast<float>(weight * scale_);
    if (from_zero) {
      std::fill(x_.begin(), x_.end(), 0.0F), std::fill(p_.begin(), p_.end(), 0.0);
      std::fill(rest_.begin(), rest_.end(), 0.0);
      fine_.add_scaled(scale, b_, {}, x_);
    } else {
      fine_.multiply(x_, image_);
      fine_.add_scaled(scale, b_, image_, x_);
      schur_->multiply(p_, rest_);
    }
    fine_.hold(x_);
    fine_.volume_change(x_, entries_);
    pressures_.sum(entries_, change_);
    each_in_shares(options_.threads, rest_.size(),
                   [&](std::size_t r) { rest_[r] = wanted(r, weight) / weight - rest_[r]; });
    schur_->improve(with, rest_, p_);
    pressures_.spread(std::span(p_).first(pressures_.rows()), entries_);
    fine_.pressure_force(entries_, image_);
    fine_.add_scaled(-scale, image_, {}, x_);
  }

  /// The required value of ω S p for (ω (S − C) + C) p = B t.
  double wanted(std::size_t r, double weight) const {
    return change_[r] + (weight - 1.0) * pressures_.compliance()[r] * p_[r];
  }

  std::vector<Law> laws_;  ///< softened; body_ points to them
  MultigridBody body_;
  MultigridOptions options_;
  PressureRows pressures_;
  FineLevel fine_;
  std::optional<SchurComplement> schur_;
  OctreeSpace grids_;
  double scale_ = 1.0;  ///< Â⁻¹ = scale D⁻¹
  double contrast_ = 1.0, strength_ = 1.0;
  Solves solves_;
  std::vector<float> b_, x_, image_, entries_;
  std::vector<double> p_;  ///< with room for the ghosts of S
  std::vector<double> change_, rest_;
};

}  // namespace

double pressure_contrast(const MultigridBody& body, std::span<const double> g) {
  const std::size_t points = points_per_element(body.body.mesh.type);
  double largest = 1.0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Law& law = body.body.law(i / points);
    if (law.mean_dilatation && g[i] > 0.0) largest = std::max(largest, law.bulk / g[i]);
  }
  return body.node_map->max_all(largest);
}

std::unique_ptr<Multigrid::Hierarchy> make_mixed_multigrid(const MultigridBody& body,
                                                           const MultigridOptions& options) {
  auto made = std::make_unique<MixedMultigrid>(body, options);
  if (!made->fits()) return nullptr;
  return made;
}

}  // namespace kacanov
