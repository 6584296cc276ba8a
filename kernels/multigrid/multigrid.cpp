// SPDX-License-Identifier: BSD-3-Clause
// Matrix-free multigrid: choice of the hierarchy.
#include "multigrid/multigrid.hpp"

#include <utility>

#include <kacanov/corner_means.hpp>
#include "multigrid/background_hierarchy.hpp"
#include "multigrid/element_pressures.hpp"
#include "multigrid/hierarchy.hpp"
#include "multigrid/modes_hierarchy.hpp"
#include "multigrid/pressure_hierarchy.hpp"

namespace kacanov {

namespace {

/// Beyond this, cycles with element pressures need such accurate solves with S that aggregates are as fast.
constexpr double most_element_contrast = 1e5;

/// build() selects one of three hierarchies: background grids while shear is not far below bulk and they fit
/// the body; aggregates until pressures pay; then pressures for good. With averages over elements, pressures
/// that no longer pay, or do not fit, are not tried again.
class ChosenHierarchy final : public Multigrid::Hierarchy {
 public:
  ChosenHierarchy(const MultigridBody& body, const MultigridOptions& options)
      : body_(body), options_(options) {
    if (!corner_moduli(body.body).empty())
      averages_ = Averages::round_corners;
    else if (averages_over_elements(body.body))
      averages_ = Averages::over_elements;
  }

  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    const bool flows = mean_contrast(body_, g) >= options_.grid_contrast;
    const double contrast = averages_ == Averages::none ? 1.0 : pressure_contrast(body_, g);
    if (averages_ == Averages::over_elements && contrast > most_element_contrast) give_up_pressures();
    if (kind_ != Kind::pressures && pressures_pay(contrast, flows) &&
        !take(Kind::pressures, make_pressure_hierarchy(body_, options_)))
      give_up_pressures();
    if (kind_ == Kind::none && !flows) take(Kind::grids, make_background_hierarchy(body_, options_));
    if (kind_ == Kind::none || (kind_ == Kind::grids && flows))
      take(Kind::modes, make_modes_hierarchy(body_, options_));
    chosen_->build(g, blocks, space);
  }
  void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    chosen_->rebuild(blocks, space);
  }
  void apply(std::span<const double> r, std::span<double> z, const Multigrid::Factors& factors) override {
    chosen_->apply(r, z, factors);
  }
  void secant(std::span<double> g) const override {
    if (chosen_) return chosen_->secant(g);
    const std::size_t points = points_per_element(body_.body.mesh.type);
    for (std::size_t i = 0; i < g.size(); ++i) g[i] = body_.body.law(i / points).secant(0.0);
  }
  int kind() const noexcept override { return static_cast<int>(kind_); }
  int levels() const noexcept override { return chosen_ ? chosen_->levels() : 1; }
  std::size_t bytes() const noexcept override { return chosen_ ? chosen_->bytes() : 0; }

 private:
  enum class Kind { none, grids, modes, pressures };
  enum class Averages { none, round_corners, over_elements };

  bool pressures_pay(double contrast, bool flows) const {
    if (averages_ == Averages::over_elements) return flows && contrast >= options_.element_contrast;
    return averages_ == Averages::round_corners && contrast >= options_.pressure_contrast;
  }

  void give_up_pressures() {
    averages_ = Averages::none;
    if (kind_ == Kind::pressures) kind_ = Kind::none;
  }

  /// Installs the hierarchy, unless it is null.
  bool take(Kind kind, std::unique_ptr<Multigrid::Hierarchy> hierarchy) {
    if (!hierarchy) return false;
    kind_ = kind, chosen_ = std::move(hierarchy);
    return true;
  }

  MultigridBody body_;
  MultigridOptions options_;
  Averages averages_ = Averages::none;
  Kind kind_ = Kind::none;
  std::unique_ptr<Multigrid::Hierarchy> chosen_;
};

}  // namespace

Multigrid::Multigrid(const MultigridBody& body, const MultigridOptions& options) {
  if (body.dim() == 3)
    hierarchy_ = std::make_unique<ChosenHierarchy>(body, options);
  else
    hierarchy_ = make_modes_hierarchy(body, options);
}

Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;

void Multigrid::build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space) {
  hierarchy_->build(g, blocks, space);
}

void Multigrid::rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space) {
  hierarchy_->rebuild(blocks, space);
}

void Multigrid::secant(std::span<double> g) const { hierarchy_->secant(g); }

void Multigrid::apply(std::span<const double> r, std::span<double> z, const Factors& factors) {
  hierarchy_->apply(r, z, factors);
}

int Multigrid::kind() const noexcept { return hierarchy_->kind(); }

int Multigrid::levels() const noexcept { return hierarchy_->levels(); }

std::size_t Multigrid::bytes() const noexcept { return hierarchy_->bytes(); }

}  // namespace kacanov
