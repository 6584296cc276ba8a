// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of background grids below the operator.
#include "multigrid/background_hierarchy.hpp"

#include <array>
#include <optional>
#include <vector>

#include "multigrid/fine_level.hpp"
#include "multigrid/grid_hierarchy.hpp"
#include "multigrid/grid_stiffness.hpp"
#include "multigrid/softened_laws.hpp"
#include "operator/threads.hpp"

namespace kacanov {
namespace {

/// Edge of the first grid over the node spacing, degree and range of the fine smoother: 3, 4 and 15 or 5, 6
/// and 30 take the same time within 5 % (docs/experiments.md#background-cycle).
constexpr double first_grid = 4.0;
constexpr int fine_degree = 5;
constexpr double fine_range = 20.0;

class BackgroundHierarchy final : public Multigrid::Hierarchy {
 public:
  BackgroundHierarchy(const MultigridBody& body, const MultigridOptions& options)
      : laws_(softened(body.body.laws)),
        body_(with_laws(body, laws_)),
        options_(options),
        grids_(body_, nullptr, first_grid, options.threads) {}

  bool pays() const { return grids_.fit().pays(); }

  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    if (!fine_) prepare();
    fine_->build(g, blocks, space);
    fine_->choose_smoother(fine_degree, fine_range);
    grids_.build(g, stiffnesses());
  }

  void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    fine_->rebuild(blocks, space);
    grids_.change(stiffnesses());
  }

  void secant(std::span<double> g) const override { fine_->secant(g); }

  void apply(std::span<const double> r, std::span<double> z, const Multigrid::Factors& factors) override {
    each_in_shares(options_.threads, r.size(),
                   [&](std::size_t i) { b_[i] = static_cast<float>(factors.in * r[i]); });
    fine_->hold(b_);
    smooth(true);
    fine_->multiply(x_, image_);
    each_in_shares(options_.threads, b_.size(), [&](std::size_t i) { image_[i] = b_[i] - image_[i]; });
    fine_->project(image_);
    step_.assign(x_.size(), 0.0F);
    grids_.correct(image_, {}, step_, {});
    body_.node_map->forward(std::span<float>(step_), 3);
    fine_->project(step_);
    each_in_shares(options_.threads, x_.size(), [&](std::size_t i) { x_[i] += step_[i]; });
    smooth(false);
    each_in_shares(options_.threads, z.size(),
                   [&](std::size_t i) { z[i] = factors.out * static_cast<double>(x_[i]); });
  }

  int levels() const noexcept override { return 1 + grids_.levels(); }

  std::size_t bytes() const noexcept override {
    return (fine_ ? fine_->bytes() : 0) + grids_.bytes() +
           (b_.size() + x_.size() + image_.size() + step_.size()) * sizeof(float);
  }

 private:
  /// Data that are not needed if the grid does not fit the body.
  void prepare() {
    fine_.emplace(body_, options_);
    body_.like = nullptr;  // may be destroyed
    for (auto* v : {&b_, &x_, &image_, &step_}) v->resize(body_.unknowns());
  }

  void smooth(bool from_zero) {
    fine_->smoother().smooth<float>(
        from_zero, {b_, x_, step_, image_},
        [this](std::span<const float> x, std::span<float> y) { fine_->multiply(x, y); },
        [this](const auto& weights, std::span<const float> b, std::span<const float> image,
               std::span<float> step, std::span<float> x) { fine_->relax(weights, b, image, step, x); });
  }

  std::vector<NodeBlock> stiffnesses() const { return grid_stiffnesses(*fine_, body_.owned_nodes()); }

  std::vector<Law> laws_;  ///< softened; body_ points to them
  MultigridBody body_;
  MultigridOptions options_;
  GridHierarchy grids_;
  std::optional<FineLevel> fine_;
  std::vector<float> b_, x_, image_, step_;
};

}  // namespace

std::unique_ptr<Multigrid::Hierarchy> make_background_hierarchy(const MultigridBody& body,
                                                                const MultigridOptions& options) {
  auto made = std::make_unique<BackgroundHierarchy>(body, options);
  if (!made->pays()) return nullptr;
  return made;
}

double mean_contrast(const MultigridBody& body, std::span<const double> g) {
  const std::size_t points = points_per_element(body.body.mesh.type);
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g[i] > 0.0) sums[0] += body.body.law(i / points).bulk / g[i], sums[1] += 1.0;
  body.node_map->sum_all(sums);
  return sums[1] > 0.0 ? sums[0] / sums[1] : 1.0;
}

}  // namespace kacanov
