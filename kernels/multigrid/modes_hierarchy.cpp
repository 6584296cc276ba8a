// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy over the rigid motions of aggregates.
#include "multigrid/modes_hierarchy.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "multigrid/aggregate_motions.hpp"
#include "multigrid/aggregation.hpp"
#include "multigrid/chebyshev.hpp"
#include "multigrid/coarse_solver.hpp"
#include "multigrid/direct_solve.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/softened_laws.hpp"
#include "multigrid/sums.hpp"
#include "operator/threads.hpp"

namespace kacanov {
namespace {

/// A coarse level with its smoother, its vectors and the transfer to the next level.
template <int M>
struct Stage {
  RigidLevel<M> level;
  std::vector<std::int32_t> group;  ///< of each owned row, in the next level; empty on the last
  std::vector<Vector3> offset;      ///< of each owned row, from the centre of its group
  Chebyshev smoother;
  Vector b, x, step, image;

  explicit Stage(RigidLevel<M> l) : level(std::move(l)) {
    for (auto* v : {&b, &x, &step, &image}) v->resize(level.size());
  }
};

constexpr std::int64_t direct_rows = 400;

template <int M>
class ModesHierarchy final : public Multigrid::Hierarchy {
 public:
  ModesHierarchy(const MultigridBody& body, const MultigridOptions& options)
      : laws_(softened(body.body.laws)),
        body_(with_laws(body, laws_)),
        options_(options),
        fine_(body_, options) {}

  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    forget_last();
    fine_.build(g, blocks, space);
    fine_.choose_smoother(options_.fine_degree, options_.fine_range);
    if (!motions_) {
      motions_.emplace(body_, g, options_);
      stages_.emplace_back(motions_->make_level());
    }
    stages_.erase(stages_.begin() + 1, stages_.end());
    motions_->sum(g, {blocks, space}, stages_.front().level);
    complete();
  }

  void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    forget_last();
    stages_.erase(stages_.begin() + 1, stages_.end());
    Vector g(body_.body.secant_count());
    fine_.secant(g);
    motions_->change(g, {fine_.blocks(), fine_.space()}, {blocks, space}, stages_.front().level);
    fine_.rebuild(blocks, space);
    complete();
  }

  void secant(std::span<double> g) const override { fine_.secant(g); }

  void apply(std::span<const double> r, std::span<double> z, const Multigrid::Factors& factors) override {
    each_in_shares(options_.threads, r.size(),
                   [&](std::size_t i) { b_[i] = static_cast<float>(factors.in * r[i]); });
    fine_.hold(b_);
    const auto multiply = [this](std::span<const float> x, std::span<float> y) { fine_.multiply(x, y); };
    const auto relax = [this](const auto& weights, std::span<const float> b, std::span<const float> image,
                              std::span<float> step,
                              std::span<float> x) { fine_.relax(weights, b, image, step, x); };
    fine_.smoother().template smooth<float>(true, {b_, x_, step_, image_}, multiply, relax);
    fine_.multiply(x_, image_);
    each_in_shares(options_.threads, b_.size(), [&](std::size_t i) { image_[i] = b_[i] - image_[i]; });
    fine_.project(image_);
    auto& first = stages_.front();
    motions_->restrict_forces(image_, first.b);
    cycle(0);
    motions_->prolong(first.x, options_.fine_gain, image_);
    body_.node_map->forward(std::span<float>(image_), static_cast<int>(body_.dim()));
    fine_.project(image_);
    each_in_shares(options_.threads, x_.size(), [&](std::size_t i) { x_[i] += image_[i]; });
    fine_.smoother().template smooth<float>(false, {b_, x_, step_, image_}, multiply, relax);
    each_in_shares(options_.threads, z.size(),
                   [&](std::size_t i) { z[i] = factors.out * static_cast<double>(x_[i]); });
  }

  int levels() const noexcept override { return 1 + static_cast<int>(stages_.size()); }

  std::size_t bytes() const noexcept override {
    std::size_t sum = fine_.bytes() + (b_.size() + x_.size() + step_.size() + image_.size()) * sizeof(float);
    if (motions_) sum += motions_->bytes();
    for (const auto& stage : stages_)
      sum += stage.level.bytes() + 4 * stage.level.size() * sizeof(double) +
             stage.group.size() * sizeof(std::int32_t) + stage.offset.size() * sizeof(Vector3);
    return sum + (direct_ ? direct_->bytes() : 0);
  }

 private:
  void forget_last() {
    direct_.reset();
    coarse_.reset();
  }

  /// Sets up all levels below the first coarse one, and the smoothers of these levels.
  void complete() {
    while (stages_.back().level.total() > direct_rows) {
      auto& stage = stages_.back();
      if (options_.make_coarse && stage.level.total() <= options_.coarse_rows) {
        coarse_ = options_.make_coarse(coarse_matrix(stage.level, motions_->length()));
        break;
      }
      const std::int64_t before = stage.level.total();
      stage.group = aggregate(stage.level.couplings(), options_.coarse_size);
      RigidLevel<M> next = stage.level.coarsened(stage.group, motions_->length());
      if (next.total() > before / 2) {
        stage.group.clear();
        break;
      }
      const auto centres = stage.level.centres();
      stage.offset.clear();
      for (std::size_t i = 0; i < stage.group.size(); ++i) {
        const auto& c = next.centres()[stage.group[i]];
        stage.offset.push_back({centres[i][0] - c[0], centres[i][1] - c[1], centres[i][2] - c[2]});
      }
      stages_.emplace_back(std::move(next));
    }
    if (!coarse_) direct_.emplace(stages_.back().level);
    for (std::size_t k = 0; k + 1 < stages_.size(); ++k) {  // the last level needs no smoother
      const double largest = stages_[k].level.largest_eigenvalue();
      stages_[k].smoother = {options_.coarse_degree, largest / options_.coarse_range, largest};
    }
    for (auto* v : {&b_, &x_, &step_, &image_}) v->resize(body_.unknowns());
  }

  /// stages_[k].x = a cycle, starting from zero, on stages_[k].b.
  void cycle(std::size_t k) {
    Stage<M>& stage = stages_[k];
    const std::size_t owned = stage.level.owned_size();
    const auto first = [owned](Vector& v) { return std::span(v).first(owned); };
    if (k + 1 == stages_.size()) {
      if (coarse_) return coarse_->solve(first(stage.b), first(stage.x));
      return direct_->solve(first(stage.b), first(stage.x));
    }
    const auto multiply = [&](std::span<const double>, std::span<double> y) {
      stage.level.multiply(stage.x, y);
    };
    const auto relax = [&](const auto& weights, std::span<const double> b, std::span<const double> image,
                           std::span<double> step,
                           std::span<double> x) { stage.level.relax(weights, b, image, step, x); };
    const auto smooth = [&](bool from_zero) {
      stage.smoother.template smooth<double>(
          from_zero, {first(stage.b), first(stage.x), first(stage.step), first(stage.image)}, multiply,
          relax);
    };
    smooth(true);
    Stage<M>& next = stages_[k + 1];
    for (int c = 0; c < options_.cycles; ++c) {
      if (c > 0 && k + 2 == stages_.size() && direct_) break;  // the last level is solved exactly
      stage.level.multiply(stage.x, stage.image);
      std::fill(next.b.begin(), next.b.end(), 0.0);
      for (std::size_t i = 0; i < stage.group.size(); ++i) {
        std::array<double, M> force{};
        for (std::size_t m = 0; m < M; ++m) force[m] = stage.b[i * M + m] - stage.image[i * M + m];
        double* to = next.b.data() + static_cast<std::size_t>(stage.group[i]) * M;
        RigidMotion<M>::add_from_part(force.data(), stage.offset[i].data(), 1.0 / motions_->length(), to);
      }
      cycle(k + 1);
      for (std::size_t i = 0; i < stage.group.size(); ++i) {
        const double* from = next.x.data() + static_cast<std::size_t>(stage.group[i]) * M;
        double* to = stage.x.data() + i * M;
        std::array<double, M> scaled{};
        for (std::size_t m = 0; m < M; ++m) scaled[m] = options_.coarse_gain * from[m];
        RigidMotion<M>::add_to_part(scaled.data(), stage.offset[i].data(), 1.0 / motions_->length(), to);
      }
    }
    smooth(false);
  }

  std::vector<Law> laws_;  ///< softened; body_ points to them
  MultigridBody body_;
  MultigridOptions options_;
  FineLevel fine_;
  std::optional<AggregateMotions<M>> motions_;
  std::vector<Stage<M>> stages_;          ///< the first stage lives as long as the aggregates
  std::optional<DirectSolve<M>> direct_;  ///< of the last stage, unless `coarse_` solves it
  std::unique_ptr<CoarseSolver> coarse_;
  std::vector<float> b_, x_, step_, image_;
};

}  // namespace

std::unique_ptr<Multigrid::Hierarchy> make_modes_hierarchy(const MultigridBody& body,
                                                           const MultigridOptions& options) {
  if (body.dim() == 3) return std::make_unique<ModesHierarchy<6>>(body, options);
  return std::make_unique<ModesHierarchy<3>>(body, options);
}

}  // namespace kacanov
