// SPDX-License-Identifier: BSD-3-Clause
// Matrix-free multigrid: the cycle on displacements, and the choice of the hierarchy.
#include "multigrid/multigrid.hpp"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "multigrid/aggregation/coarse_space.hpp"
#include "multigrid/cycle.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/octree/coarse_space.hpp"
#include "multigrid/pressure_rows.hpp"

namespace kacanov {

namespace {

/// Beyond this, cycles with element pressures need such accurate solves with S that aggregates are as fast.
constexpr double most_element_contrast = 1e5;

/// Chebyshev iteration on the operator, with a coarse space below.
template <class CoarseSpace>
class DisplacementMultigrid final : public Multigrid::Hierarchy {
 public:
  DisplacementMultigrid(const MultigridBody& body, const MultigridOptions& options)
      : laws_(softened(body.body.laws)), coarse_(with_laws(body, laws_), options) {
    if (!coarse_.fits()) return;
    fine_.emplace(with_laws(body, laws_), options);
    for (auto* v : {&b_, &x_, &step_, &image_}) v->resize(body.unknowns());
  }
  bool fits() const noexcept { return fine_.has_value(); }

  void setup(std::span<const double> g, const NodeSupports& supports) override {
    fine_->setup(g, supports);
    fine_->choose_smoother(coarse_.fine_degree(), coarse_.fine_range());
    coarse_.setup(g, supports, *fine_);
  }
  void update(const NodeSupports& supports) override {
    const auto [blocks, space] = fine_->update(supports);
    coarse_.update({blocks, space}, supports, *fine_);
  }
  void apply(std::span<const double> r, std::span<double> z, const Multigrid::Factors& factors) override {
    fine_->load(factors.in, r, b_);
    cycle(*this);
    fine_->store(factors.out, x_, z);
  }
  void secant(std::span<double> g) const override { fine_->secant(g); }
  int levels() const noexcept override { return 1 + coarse_.levels(); }
  std::size_t bytes() const noexcept override {
    return fine_->bytes() + coarse_.bytes() +
           (b_.size() + x_.size() + step_.size() + image_.size()) * sizeof(float);
  }

  // For cycle(): the coarse space is the last level.
  static bool is_last(std::size_t k) noexcept { return k == 1; }
  static int corrections(std::size_t) noexcept { return 1; }
  void smooth(std::size_t, bool before) { fine_->smooth(before, {b_, x_, step_, image_}); }
  void restrict_residual(std::size_t) {
    fine_->residual(b_, x_, {}, image_);
    coarse_.restrict_forces(image_);
  }
  void solve_last() { coarse_.solve(); }
  void add_correction(std::size_t) {
    coarse_.prolong(step_);
    fine_->add_correction(step_, x_);
  }

 private:
  std::vector<Law> laws_;  ///< softened; the levels' bodies point to them
  CoarseSpace coarse_;
  std::optional<FineLevel> fine_;  ///< if the coarse space fits
  std::vector<float> b_, x_, step_, image_;
};

template <class CoarseSpace>
std::unique_ptr<Multigrid::Hierarchy> make_displacement_multigrid(const MultigridBody& body,
                                                                  const MultigridOptions& options) {
  auto made = std::make_unique<DisplacementMultigrid<CoarseSpace>>(body, options);
  if (!made->fits()) return nullptr;
  return made;
}

/// Average of k0/g over all points; `g`: elements × points. Collective.
double mean_contrast(const MultigridBody& body, std::span<const double> g) {
  const std::size_t points = points_per_element(body.body.mesh.type);
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < g.size(); ++i)
    if (g[i] > 0.0) sums[0] += body.body.law(i / points).bulk / g[i], sums[1] += 1.0;
  body.node_map->sum_all(sums);
  return sums[1] > 0.0 ? sums[0] / sums[1] : 1.0;
}

}  // namespace

Multigrid::Multigrid(const MultigridBody& body, const MultigridOptions& options)
    : body_(body), options_(options) {
  if (body.dim() != 3)
    hierarchy_ = make_displacement_multigrid<AggregationSpace<3>>(body, options);
  else if (!corner_moduli(body.body).empty())
    averages_ = Averages::round_corners;
  else if (averages_over_elements(body.body))
    averages_ = Averages::over_elements;
}

Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;

void Multigrid::setup(std::span<const double> g, std::span<const NodeBlock> blocks,
                      const ConstrainedSpace& space) {
  if (body_.dim() == 3) choose(g);
  hierarchy_->setup(g, {blocks, space});
}

/// Background grids while shear is not far below bulk and they fit the body; aggregates until pressures pay;
/// then pressures for good. With averages over elements, pressures that no longer pay, or do not fit, are not
/// tried again.
void Multigrid::choose(std::span<const double> g) {
  const bool flows = mean_contrast(body_, g) >= options_.grid_contrast;
  const double contrast = averages_ == Averages::none ? 1.0 : pressure_contrast(body_, g);
  if (averages_ == Averages::over_elements && contrast > most_element_contrast) give_up_pressures();
  if (kind_ != Kind::pressures && pressures_pay(contrast, flows) &&
      !take(Kind::pressures, make_mixed_multigrid(body_, options_)))
    give_up_pressures();
  if (kind_ == Kind::none && !flows)
    take(Kind::grids, make_displacement_multigrid<OctreeSpace>(body_, options_));
  if (kind_ == Kind::none || (kind_ == Kind::grids && flows))
    take(Kind::modes, make_displacement_multigrid<AggregationSpace<6>>(body_, options_));
}

bool Multigrid::pressures_pay(double contrast, bool flows) const {
  if (averages_ == Averages::over_elements) return flows && contrast >= options_.element_contrast;
  return averages_ == Averages::round_corners && contrast >= options_.pressure_contrast;
}

void Multigrid::give_up_pressures() {
  averages_ = Averages::none;
  if (kind_ == Kind::pressures) kind_ = Kind::none;
}

/// Installs the hierarchy, unless it is null.
bool Multigrid::take(Kind kind, std::unique_ptr<Hierarchy> hierarchy) {
  if (!hierarchy) return false;
  kind_ = kind, hierarchy_ = std::move(hierarchy);
  return true;
}

void Multigrid::update(std::span<const NodeBlock> blocks, const ConstrainedSpace& space) {
  hierarchy_->update({blocks, space});
}

void Multigrid::secant(std::span<double> g) const {
  if (hierarchy_) return hierarchy_->secant(g);
  const std::size_t points = points_per_element(body_.body.mesh.type);
  for (std::size_t i = 0; i < g.size(); ++i) g[i] = body_.body.law(i / points).secant(0.0);
}

void Multigrid::apply(std::span<const double> r, std::span<double> z, const Factors& factors) {
  hierarchy_->apply(r, z, factors);
}

int Multigrid::levels() const noexcept { return hierarchy_ ? hierarchy_->levels() : 1; }

std::size_t Multigrid::bytes() const noexcept { return hierarchy_ ? hierarchy_->bytes() : 0; }

}  // namespace kacanov
