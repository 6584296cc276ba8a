// SPDX-License-Identifier: BSD-3-Clause
// The outer loop: Kacanov's method (7) round the contact loop.
#include "nonlinear/outer_loop.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "contact/dual_admm.hpp"

namespace kacanov {
namespace {

/// The contact loop of an outer step is taken this far below the residual of the step before; the first one,
/// which is elastic, as well. A half there leaves slip on fine meshes to Newton steps that move it on by a
/// few rows of nodes each, a tenth costs more than it saves.
constexpr double inner_reduction = 0.2;
/// The preconditioner is rebuilt once a step needs this many CG iterations more than it would have right
/// after the last setup: half of what a setup costs.
constexpr double setup_worth = 5.0;
/// It is rebuilt before a step where g has moved by this share in the mean.
constexpr double drift_worth = 0.05;
/// ... or where a penalty has moved by this factor (elastic beam, ADMM: 144 applications instead of 212).
constexpr double penalty_worth = 3.0;
/// Semismooth Newton steps take the secant while the residual of equilibrium is above LoopState::reach: the
/// tangent of a state that is far off sends them too far, and contact and slip with them. Where it has, the
/// reach becomes this share of that residual.
constexpr double reach_cut = 0.5;
/// ... but not less than this: below it is contact that goes to and fro, not the tangent that goes too far.
constexpr double least_reach = 0.003;
/// First penalty, times λ_min over the root of the mesh width relative to the contact surface. Three times as
/// much is as good for beams, and worse for the half ball; a third costs a few per cent more (operator
/// applications of whole runs).
constexpr double first_penalty = 0.1;
/// CG iterations of a rough estimate of λ_max.
constexpr int rough_iterations = 2;
/// ADMM iterations between two looks at the penalties' balance (and, in Kacanov's method, at g) after the
/// first step. Ten take 6 % more of them; with three, penalties that follow Coulomb's bounds kept one beam
/// from converging.
constexpr int balancing_iterations = 5;
/// A step of fewer moves the penalties by less.
constexpr double trusted_iterations = 4.0;
/// Penalties stay between this over λ_min, which contracts errors at held rows to a quarter (more costs CG
/// iterations), and that share of it.
constexpr double largest_penalty = 3.0;
constexpr double smallest_share = 1e-4;
/// Relative accuracy of a semismooth Newton step.
constexpr double solve_reduction = 0.03;
/// A step that starts within this factor of the tolerance is solved to a fifth of the tolerance: it may be
/// the last.
constexpr double last_reach = 100.0;
constexpr double last_share = 0.2;
/// Semismooth Newton decides by λ + c(w − ρ), c this share of ADMM's penalty. A whole penalty makes slipping
/// points flip on the half ball (338 applications instead of 145), a tenth costs steps on beams.
constexpr double decision_share = 0.3;
/// Newton steps without a new best residual before ADMM takes over.
constexpr int patience = 6;
/// ADMM hands back early at this share of the best residual of the Newton steps before.
constexpr double retreat_gain = 0.1;
constexpr int max_damping_trials = 6;
/// A displacement of this many body sizes is a run that goes nowhere.
constexpr double most_displacement = 1e3;

/// Operator applications between two looks at whether the run is to stop, which cost a reduction.
constexpr std::uint64_t applications_per_question = 4;

/// How much further than the tolerance the residuals have to fall for the duality gap to meet it. Where a
/// body moves far and strains little, their work along the motion is large beside the stored energy.
double gap_share(const Certificate& c) {
  const double others =
      std::max({c.equilibrium, c.penetration, c.tension, c.complementarity, c.friction_cone});
  return others > 0.0 && std::isfinite(c.duality_gap)
             ? std::clamp(others / std::max(others, c.duality_gap), 1e-4, 1.0)
             : 1.0;
}

Vector lumped_volume(const Part& part) {
  Vector volume(part.nodes(), 0.0), element(part.element_count());
  reference::volumes(part.body(), element);
  const auto npe = static_cast<std::size_t>(nodes_per_element(part.type));
  for (std::size_t k = 0; k < part.elements.size(); ++k)
    volume[static_cast<std::size_t>(part.elements[k])] += element[k / npe] / static_cast<double>(npe);
  part.halo.sum(volume, 1);
  return volume;
}

/// Longest side of the body's bounding box.
double body_extent(const Part& part) {
  const auto dim = static_cast<std::size_t>(part.dim());
  double extent = 0.0;
  for (std::size_t c = 0; c < dim; ++c) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = c; i < part.coordinates.size(); i += dim) {
      low = std::min(low, part.coordinates[i]);
      high = std::max(high, part.coordinates[i]);
    }
    extent = std::max(extent, part.halo.max_all(high) + part.halo.max_all(-low));
  }
  return extent;
}

/// To be called before `bytes` are allocated in a few pieces. The allocator keeps what is free (Open MPI
/// tells it to keep everything), but new pieces need not fit into old holes: before large ones the holes go
/// back to the system. Before small ones that costs more time than it is worth.
void make_room(std::size_t bytes) {
  constexpr std::size_t large = std::size_t{64} << 20;
  if (bytes >= large) malloc_trim(0);
}

}  // namespace

OuterLoop::OuterLoop(const Part& part, const SolverOptions& options, const RunOptions& run)
    : part_(part),
      options_(options),
      run_(run),
      start_(MPI_Wtime()),
      space_(part),
      traces_(part),
      op_(part, run.threads, run.instruction_set),
      amg_(make_preconditioner(options.preconditioner, part, run.threads, run.instruction_set)),
      internal_(part.unknowns()),
      diagonal_(op_.diagonal()) {
  extent_ = body_extent(part);
  const std::size_t points = part.contact.size();
  state_.omega.assign(part.unknowns(), 0.0);
  part.prescribe(state_.omega);
  state_.trace = state_.phi = state_.lambda = ContactValues(points);
  state_.bound.resize(points);
  take_gaps();
  work_.resize(part.unknowns());
  traces_.evaluate(state_.omega, state_.trace);
  for (std::size_t i = 0; i < points; ++i)
    state_.phi.normal[i] = std::min(state_.trace.normal[i], state_.gap[i]);
  bool slides = false;
  for (const auto& point : part.contact) slides = slides || point.tangents > 0;
  friction_ = part.halo.any(slides);
  linear_ = std::all_of(part.laws.begin(), part.laws.end(),
                        [](const Law& law) { return law.kind == Law::Kind::linear; });
  if (options.stop == SolverOptions::Stop::paper) volume_ = lumped_volume(part);
  update_bounds();
  problem_ = {&space_, &traces_,
              [this](std::span<const double> x, std::span<double> y) { return op_.apply(x, y); },
              [this](std::span<const double> r, std::span<double> z) { amg_->apply(r, z); }};
  if (run.stop_requested) {
    op_.watch([this] {
      if (op_.applications() % applications_per_question == 0 && stop_agreed()) throw Interrupted{};
    });
  }
}

void OuterLoop::take_gaps() {
  state_.gap.clear();
  for (const ContactPoint& point : part_.contact) state_.gap.push_back(point.gap);
}

double OuterLoop::update_bounds() {
  double change = 0.0, pressure = 0.0;
  for (std::size_t i = 0; i < part_.contact.size(); ++i) {
    const double bound = part_.contact[i].tresca + part_.contact[i].coulomb * state_.lambda.normal[i];
    change = std::max(change, std::abs(bound - state_.bound[i]));
    pressure = std::max(pressure, state_.lambda.normal[i]);
    state_.bound[i] = bound;
  }
  change = part_.halo.max_all(change);
  pressure = part_.halo.max_all(pressure);
  return pressure > 0.0 ? change / pressure : 0.0;
}

void OuterLoop::report(const ProgressStep& step) const {
  if (run_.progress && part_.halo.rank == 0) run_.progress(step);
}

/// λ_max(K_I|A), the compliance of the part that lifts off, is to λ_min as its size to the mesh width: r_A
/// goes with 1/λ_min and the root of that.
double OuterLoop::rough_penalty() const {
  const double width = std::pow(static_cast<double>(part_.total_contact), -1.0 / (part_.dim() - 1));
  const double normal_min = rough_lambda_min(part_, diagonal_, false);
  return normal_min > 0.0 ? first_penalty * std::sqrt(width) / normal_min : 1.0;
}

void OuterLoop::choose_first_penalty(Result& result) {
  if (part_.total_contact == 0) return;
  const double before = MPI_Wtime();
  const auto applications = op_.applications();
  if (options_.penalty == SolverOptions::Penalty::paper) {
    const auto spectrum = estimate_spectrum(part_, op_, *amg_, secant(), friction_,
                                            {options_.spectrum_tolerance, options_.max_cg});
    preconditioner_stale_ = true;
    result.lambda_min = spectrum.lambda_min;
    result.lambda_max = spectrum.lambda_max;
    result.r_star = spectrum.r_star;
    result.cg_iterations += spectrum.cg_iterations;
    penalty_ = {result.r_star, result.r_star};
  } else {
    const auto points = part_.contact.size();
    result.lambda_min = rough_lambda_min(part_, diagonal_, friction_);
    const double r = options_.penalty == SolverOptions::Penalty::automatic ? rough_penalty() : options_.r;
    penalty_ = {r, r};
    set_up_preconditioner(true, penalty_blocks(), space_);
    setup_penalty_ = penalty_;
    if (part_.loose_modes == 0)
      result.lambda_max = rough_lambda_max(
          part_, op_, *amg_, TraceRows(part_, std::vector<TraceChoice>(points, {true, false})),
          TraceRows(part_, std::vector<TraceChoice>(points)), rough_iterations);
    if (result.lambda_min > 0.0 && result.lambda_max > 0.0)
      result.r_star = 1.0 / std::sqrt(result.lambda_min * result.lambda_max);
  }
  result.spectrum_applications += op_.applications() - applications;
  spectrum_seconds_ += MPI_Wtime() - before;
}

bool OuterLoop::touches() const {
  const auto& pressure = state_.lambda.normal;
  return part_.halo.any(std::any_of(pressure.begin(), pressure.end(), [](double p) { return p > 0.0; }));
}

void OuterLoop::balance_penalty(const AdmmResult& step, bool arrived, const Scales& scales, Result& result) {
  if (!(result.lambda_min > 0.0)) return;
  if (arrived) {
    // While nothing touches, the balance sees motion alone and lowers the penalties step after step, further
    // than contact wants them. Back to the first one: 42 iterations instead of 55, 52 instead of 57 on half
    // balls 0.3 away.
    penalty_.normal = penalty_.tangential = rough_penalty();
    result.r_active = penalty_.normal;
    return;
  }
  const double largest = largest_penalty / result.lambda_min;
  // A step of few iterations says little.
  const double trust = std::min(1.0, step.iterations / trusted_iterations);
  const auto balanced = [&](double r, double behind) {
    const double factor = std::exp(std::clamp(0.5 * trust * behind, -1.0, 1.0));
    return std::clamp(r * factor, smallest_share * largest, largest);
  };
  const auto behind = mean_behind(step.balance, scales.displacement, scales.force);
  penalty_ = {balanced(penalty_.normal, behind[0]), balanced(penalty_.tangential, behind[1])};
  if (result.outer_iterations > 0) result.r_active = penalty_.normal;
}

std::vector<NodeBlock> OuterLoop::penalty_blocks() const {
  const std::size_t points = part_.contact.size();
  auto blocks =
      TraceRows(part_, std::vector<TraceChoice>(points, {true, false})).penalty_blocks(penalty_.normal);
  const auto tangential =
      TraceRows(part_, std::vector<TraceChoice>(points, {false, true})).penalty_blocks(penalty_.tangential);
  blocks.insert(blocks.end(), tangential.begin(), tangential.end());
  return blocks;
}

/// Whether a new preconditioner pays: because it has served its time, or g has moved too far from the one it
/// was built with.
bool OuterLoop::setup_pays() {
  if (preconditioner_stale_) return true;
  if (linear_) return false;
  const Vector now = secant();
  Vector then(now.size());
  amg_->secant(then);
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < now.size(); ++i) {
    sums[0] += std::abs(now[i] - then[i]);
    sums[1] += then[i];
  }
  part_.halo.sum_all(sums);
  return sums[0] > drift_worth * sums[1];
}

Vector OuterLoop::secant() const {
  Vector g(part_.body().secant_count());
  op_.local().secant(g);
  return g;
}

/// Whether the preconditioner pins other nodes than `set`, or none at all. Every node it gets wrong costs CG
/// a few iterations.
bool OuterLoop::set_moved(std::span<const TraceChoice> set) const {
  return part_.halo.any(!std::equal(set.begin(), set.end(), pinned_set_.begin(), pinned_set_.end()));
}

/// Whether the preconditioner was built with penalties that are far from those of now.
bool OuterLoop::penalty_moved() const {
  const auto far = [](double now, double then) {
    return now > penalty_worth * then || then > penalty_worth * now;
  };
  return far(penalty_.normal, setup_penalty_.normal) ||
         (friction_ && far(penalty_.tangential, setup_penalty_.tangential));
}

void OuterLoop::set_up_preconditioner(bool worn, std::span<const NodeBlock> blocks, const Space& space) {
  if (!worn) return amg_->setup_again(blocks, space);
  amg_->setup(secant(), blocks, space);
  preconditioner_stale_ = false;
  digits_per_cg_ = 0.0;
}

void OuterLoop::watch_preconditioner(double digits, std::int64_t iterations) {
  if (iterations == 0) return;
  if (digits_per_cg_ == 0.0) digits_per_cg_ = digits / static_cast<double>(iterations);
  const double excess = static_cast<double>(iterations) - digits / digits_per_cg_;
  preconditioner_stale_ = preconditioner_stale_ || excess > setup_worth;
}

/// work_.residual = F − R(ω).
void OuterLoop::take_unbalanced() {
  for (std::size_t i = 0; i < internal_.size(); ++i) work_.residual[i] = -internal_[i];
  part_.add_load(work_.residual);
}

/// R(ω), the energy and g at the ω of now, in one pass.
void OuterLoop::update_residual() {
  energy_ = op_.residual_energy_update(state_.omega, internal_);
  secant_current_ = true;
}

Residuals OuterLoop::certify() const {
  return kkt_residuals(space_, traces_, state_, {part_.load, internal_, energy_, diagonal_});
}

void OuterLoop::take_admm_step(Result& result, ProgressStep& line, const Residuals& before) {
  const bool by_step = options_.stop == SolverOptions::Stop::paper;
  const bool automatic = options_.penalty == SolverOptions::Penalty::automatic;
  const bool first = result.outer_iterations == 0;
  const bool dual = options_.contact == SolverOptions::Contact::dual_admm;
  // The first step is elastic: prescribed displacements put in at once look like huge strains in the first
  // layer of elements. Later ones freeze g at the last iterate.
  op_.use_tangent(false);
  if (!first && !linear_ && !secant_current_) op_.update(state_.omega);
  const bool worn = first ? preconditioner_stale_ : setup_pays();
  if (worn || (!first && penalty_moved())) {
    set_up_preconditioner(worn, penalty_blocks(), space_);
    setup_penalty_ = penalty_;
    pinned_set_.clear();
  }

  AdmmOptions options;
  options.r = penalty_;
  options.relaxation =
      options_.relaxation.value_or(by_step || options_.penalty == SolverOptions::Penalty::paper ? 1.0 : 1.7);
  options.max_iterations = options_.max_contact;
  options.max_cg = options_.max_cg;
  const Scales& scales = before.scales;
  if (by_step) {
    options.step_tolerance = options_.tolerance;
    options.force_tolerance = 1e-2 * options_.tolerance * scales.force;
    options.volume = volume_;
  } else {
    const double worst = scales.displacement > 0.0 ? std::min(before.certificate.worst(), 1.0) : 1.0;
    const double reach =
        std::max(0.5 * options_.tolerance, inner_reduction * worst) * gap_share(before.certificate);
    options.force_tolerance = reach * scales.force;
    // With no displacement yet, any trace will do: the first step ends by its forces.
    options.trace_tolerance = scales.displacement > 0.0 ? reach * scales.displacement : HUGE_VAL;
    options.force_reduction = scales.force > 0.0 ? 0.0 : inner_reduction;
    if (automatic && !first) options.max_iterations = std::min(balancing_iterations, options_.max_contact);
  }
  if (first) op_.apply(state_.omega, internal_);  // the elastic force, not R(ω)
  take_unbalanced();
  traces_.add_force(state_.lambda, -1.0, work_.residual);
  const bool touched = touches();
  const auto applications = op_.applications();
  const AdmmResult step =
      dual ? dual_admm(problem_, state_, work_, options) : admm(problem_, state_, work_, options);
  result.contact_applications += op_.applications() - applications;
  watch_preconditioner(step.cg_digits, step.cg_iterations);
  update_residual();
  line.phase = dual ? "dual_admm" : "admm";
  line.r = penalty_.normal;
  // Before the first step no displacement sets a scale.
  if (automatic && !by_step)
    balance_penalty(step, !first && !touched && touches(), first ? certify().scales : scales, result);
  line.contact_iterations = step.iterations;
  line.cg_iterations = step.cg_iterations;
}

void OuterLoop::take_damped_step(std::span<const double> delta, double curvature) {
  // Along δ the energy of the linear model falls with slope −q (1 − t). A step is too long where the true
  // force has grown past half of q more than the model says (unloading is stiffer than the tangent).
  // The solve is over: its vectors are free.
  Vector &from = work_.direction, &force = work_.image;
  from = state_.omega;
  force = internal_;
  double t = 1.0;
  for (int trial = 0;; ++trial) {
    for (std::size_t i = 0; i < from.size(); ++i) state_.omega[i] = from[i] + t * delta[i];
    update_residual();
    if (linear_ || trial == max_damping_trials) return;
    const std::array<double, 2> work = space_.dot2(delta, internal_, delta, force);
    const double grown = work[0] - work[1];
    if (std::isfinite(grown) && grown <= 1.5 * curvature) return;
    t *= std::isfinite(grown) ? std::clamp(curvature / grown, 0.1, 0.7) : 0.1;
  }
}

void OuterLoop::take_newton_step(Result& result, ProgressStep& line, const Residuals& before) {
  const bool far =
      options_.outer == SolverOptions::Outer::automatic && before.certificate.equilibrium > loop_.reach;
  const bool tangent = options_.outer != SolverOptions::Outer::kacanov && !linear_ && !far;
  if (!linear_ && !secant_current_) {
    op_.use_tangent(false);
    op_.update(state_.omega);
  }
  const ActiveSet set = decide(traces_, state_, decision_share * penalty_.normal);
  make_room(2 * sizeof(double) * part_.body().secant_count());  // g of now and then
  const bool worn = setup_pays();
  if (worn || set_moved(set.held)) {
    pinned_set_ = set.held;
    const TraceRows rows(part_, set.held);
    Space space(part_);
    rows.hold_in(space);
    auto blocks = rows.pinning_blocks(diagonal_);
    const auto slip = slip_blocks(part_, set);
    blocks.insert(blocks.end(), slip.begin(), slip.end());
    set_up_preconditioner(worn, blocks, space);
  }
  // After the setup: the two do not have to fit into memory at once.
  op_.use_tangent(tangent);
  if (tangent) {
    make_room(5 * sizeof(float) * part_.body().secant_count());
    op_.update(state_.omega);
  }
  take_unbalanced();
  Vector delta(part_.unknowns());
  // Well below the tolerance, so that answers do not depend on ranks or threads to more than that.
  const double floor = last_share * options_.tolerance * gap_share(before.certificate) * before.scales.force;
  const bool last = before.certificate.worst() <= last_reach * options_.tolerance;
  const auto applications = op_.applications();
  const ActiveSetStep step =
      active_set_step(problem_, part_, set, state_,
                      {floor, last ? 1e-3 : solve_reduction, options_.max_cg,
                       std::min(before.certificate.worst(), 1.0) * before.scales.force},
                      work_, delta);
  result.contact_applications += op_.applications() - applications;
  line.phase = tangent ? "newton" : "active_set";
  line.r = penalty_.normal;
  line.contact_iterations = 1;
  line.cg_iterations = step.cg_iterations;
  op_.forget_tangent();
  newton_failed_ = !step.solved;
  if (newton_failed_) return;
  watch_preconditioner(step.cg_digits, step.cg_iterations);
  take_damped_step(delta, step.curvature);
  traces_.evaluate(state_.omega, state_.trace);
  take_unbalanced();
  recover_multipliers(part_, traces_, set, work_.residual, state_);
}

void OuterLoop::iterate(Result& result) {
  keep(result);
  const int before_this_call = result.outer_iterations;
  if (result.outer_iterations == 0 || penalty_.normal == 0.0) choose_first_penalty(result);
  const bool by_step = options_.stop == SolverOptions::Stop::paper;
  const bool may_newton = !by_step && (options_.contact == SolverOptions::Contact::automatic ||
                                       options_.contact == SolverOptions::Contact::active_set);
  op_.residual(state_.omega, internal_);
  energy_ = op_.energy(state_.omega);
  secant_current_ = false;  // the first step is elastic
  Residuals residuals = certify();
  auto& [best, stalled, retreat, aim, retreats, first_outer, reach] = loop_;
  bool done = false;
  Vector previous;
  while (!done && result.outer_iterations - first_outer < options_.max_outer) {
    if (result.outer_iterations > before_this_call) keep(result);
    if (by_step) previous = state_.omega;
    ProgressStep line;
    const bool newton = may_newton && result.outer_iterations > 0 && retreat == 0;
    const double equilibrium = residuals.certificate.equilibrium;
    if (newton)
      take_newton_step(result, line, residuals);
    else
      take_admm_step(result, line, residuals);
    ++result.outer_iterations;
    result.contact_iterations += line.contact_iterations;
    result.cg_iterations += line.cg_iterations;
    result.r.push_back(line.r);
    result.bound_change = update_bounds();
    residuals = certify();
    const double worst = residuals.certificate.worst();
    line.outer = result.outer_iterations;
    line.energy = residuals.energy;
    line.certificate = residuals.certificate;
    line.seconds = MPI_Wtime() - start_;
    report(line);
    if (!std::isfinite(worst) && !newton) {
      result.message = "the iteration broke down: residuals are not finite";
      return;
    }
    if (by_step) {
      for (std::size_t i = 0; i < previous.size(); ++i) previous[i] -= state_.omega[i];
      done = linear_ || space_.norm(previous) <= options_.tolerance * space_.norm(state_.omega);
      continue;
    }
    done = worst <= options_.tolerance;
    if (!done && residuals.scales.displacement > most_displacement * extent_) {
      result.message =
          "the displacement has grown to " + std::to_string(residuals.scales.displacement / extent_) +
          " times the body's size: the load is beyond what the material or the supports can carry";
      return;
    }
    if (!newton) {
      retreat = worst <= aim ? 0 : std::max(0, retreat - 1);
      continue;
    }
    if (op_.tangent() && !(residuals.certificate.equilibrium <= equilibrium))
      reach = std::max(least_reach, reach_cut * equilibrium);
    stalled = worst < 0.7 * best ? 0 : stalled + 1;
    best = std::min(best, worst);
    if (newton_failed_ || stalled >= patience || !std::isfinite(worst)) {
      // ADMM converges from anywhere; every retreat is longer than the last.
      stalled = 0;
      aim = std::isfinite(best) ? retreat_gain * best : 0.0;
      best = HUGE_VAL;
      retreat = 2 << std::min(retreats++, 6);
      preconditioner_stale_ = true;
      for (double& lambda : state_.lambda.normal) lambda = std::max(lambda, 0.0);
    }
  }
}

}  // namespace kacanov
