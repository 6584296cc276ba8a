// SPDX-License-Identifier: BSD-3-Clause
// Multigrid without a matrix on the fine level: Chebyshev on the operator, rigid motions of aggregates below.
#include "multigrid/multigrid.hpp"

#include <kacanov/corner_means.hpp>
#include "multigrid/hierarchy.hpp"
#include "multigrid/modes_hierarchy.hpp"
#include "multigrid/pressure_hierarchy.hpp"

namespace kacanov {

namespace {

/// Which of the two it is shows in a build: modes of aggregates until pressures pay, then these for good.
class ChosenHierarchy final : public Multigrid::Hierarchy {
 public:
  ChosenHierarchy(const MultigridBody& body, const MultigridOptions& options)
      : body_(body), options_(options) {}

  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const HeldSpace& space) override {
    const bool pays = pressure_contrast(body_, g) >= options_.pressure_contrast;
    if (pays && !with_pressures_) {
      chosen_ = make_pressure_hierarchy(body_, options_);
      with_pressures_ = true;
    } else if (!chosen_) {
      chosen_ = make_modes_hierarchy(body_, options_);
    }
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
  int levels() const noexcept override { return chosen_ ? chosen_->levels() : 1; }
  std::size_t bytes() const noexcept override { return chosen_ ? chosen_->bytes() : 0; }

 private:
  MultigridBody body_;
  MultigridOptions options_;
  std::unique_ptr<Multigrid::Hierarchy> chosen_;
  bool with_pressures_ = false;
};

}  // namespace

Multigrid::Multigrid(const MultigridBody& body, const MultigridOptions& options) {
  if (body.dim() == 3 && !corner_moduli(body.body).empty())
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

int Multigrid::levels() const noexcept { return hierarchy_->levels(); }

std::size_t Multigrid::bytes() const noexcept { return hierarchy_->bytes(); }

}  // namespace kacanov
