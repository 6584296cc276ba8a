// SPDX-License-Identifier: BSD-3-Clause
// Preconditioner of linear systems with contact, and the schedule of its setups.
#include "nonlinear/contact_preconditioner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "amg/assembly.hpp"
#include "contact/active_set_step.hpp"
#include "nonlinear/friction_bounds.hpp"

namespace kacanov {

bool PreconditionerSchedule::far(double now, double then) const {
  return now > tuning_.penalty_worth * then || then > tuning_.penalty_worth * now;
}

bool PreconditionerSchedule::penalty_moved(const Penalty& now, bool friction) const {
  return far(now.normal, penalty_.normal) || (friction && far(now.tangential, penalty_.tangential));
}

bool PreconditionerSchedule::set_moved(const ActiveSet& set, double penalty) const {
  return held_by_ != penalty || set.held != pinned_ ||
         !std::equal(set.slip_stiffness.begin(), set.slip_stiffness.end(), slip_stiffness_.begin(),
                     [this](double now, double then) { return !far(now, then); });
}

void PreconditionerSchedule::built() {
  stale_ = false;
  digits_per_cg_ = lost_per_digit_ = 0.0;
}

void PreconditionerSchedule::built_for(const Penalty& penalty) {
  penalty_ = penalty;
  pinned_.clear(), slip_stiffness_.clear();
}

void PreconditionerSchedule::built_for(const ActiveSet& set, double penalty) {
  pinned_ = set.held, slip_stiffness_ = set.slip_stiffness;
  held_by_ = penalty;
}

void PreconditionerSchedule::watch(double digits, std::int64_t iterations) {
  if (iterations == 0) return;
  const auto taken = static_cast<double>(iterations);
  if (digits_per_cg_ == 0.0) digits_per_cg_ = digits / taken;
  const double lost = taken - digits / digits_per_cg_;
  if (lost > tuning_.setup_worth) lost_per_digit_ = digits > 0.0 ? lost / digits : HUGE_VAL;
}

ContactPreconditioner::ContactPreconditioner(const Part& part, const BodyResponse& body,
                                             std::unique_ptr<Preconditioner> inner, const Tuning& tuning)
    : part_(&part),
      body_(&body),
      inner_(std::move(inner)),
      tuning_(tuning),
      memory_{PreconditionerSchedule(tuning), {}, nullptr, false},
      schedule_(tuning),
      friction_(has_friction(part)) {}

void ContactPreconditioner::set_up(const Penalty& penalty) {
  build(true, {PreconditionedRows::Kind::penalised_all, penalty, ActiveSet()});
}

void ContactPreconditioner::prepare(const Penalty& penalty, bool first) {
  const bool again = first ? schedule_.stale() : worn();
  if (!again && (first || !schedule_.penalty_moved(penalty, friction_))) return;
  build(again, {PreconditionedRows::Kind::penalised_all, penalty, ActiveSet()});
}

void ContactPreconditioner::prepare(const ActiveSet& set, double digits) {
  make_room(2 * sizeof(double) * part_->body().secant_count());  // current and previous g
  const bool again = worn(digits);
  if (!again && !part_->node_map.any(schedule_.set_moved(set))) return;
  build(again, {PreconditionedRows::Kind::pinned, {}, set});
}

void ContactPreconditioner::prepare(const ActiveSet& set, double penalty, double loose) {
  const bool again = worn();
  if (!again && !part_->node_map.any(schedule_.set_moved(set, penalty))) return;
  build(again, {PreconditionedRows::Kind::penalised, {penalty, loose}, set});
}

void ContactPreconditioner::watch(double digits, std::int64_t iterations) {
  schedule_.watch(digits, iterations);
  const auto unknowns = static_cast<double>(part_->total_nodes()) * static_cast<double>(part_->dim());
  const double factor =
      tuning_.factor_iterations * std::pow(unknowns / tuning_.factor_unknowns, tuning_.factor_growth);
  if (static_cast<double>(iterations) > std::min(factor, tuning_.most_iterations)) factorise();
}

bool ContactPreconditioner::factorise() {
  if (factor_ || part_->total_nodes() * part_->dim() > tuning_.most_factorised) return false;
  factor_ = std::make_unique<Factorised>(*part_);
  schedule_.mark_stale();
  return true;
}

Preconditioner& ContactPreconditioner::lend() {
  note_first(single_precision_secant());
  kind_ = made_elsewhere;
  schedule_.mark_stale();
  return *inner_;
}

bool ContactPreconditioner::worn(double digits) const {
  if (schedule_.stale(digits) || memory_.rows.size() > tuning_.most_changes) return true;
  if (body_->linear()) return false;
  const Vector now = body_->secant();
  Vector then(now.size());
  current().secant(then);
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < now.size(); ++i) {
    sums[0] += std::abs(now[i] - then[i]);
    sums[1] += then[i];
  }
  part_->node_map.sum_all(sums);
  return schedule_.drifted(sums[0], sums[1]);
}

void ContactPreconditioner::build(bool worn, PreconditionedRows rows) {
  const auto kept_rows = std::make_shared<const PreconditionedRows>(std::move(rows));
  if (worn) {
    if (may_roll_back_ && !replaced_ && had_factor_ == (factor_ != nullptr)) replaced_ = last_secant();
    memory_.rows.clear();
    set_up_with(single_precision_secant(), *kept_rows);
    schedule_.built();
  } else {
    change_to(*kept_rows);
  }
  memory_.rows.push_back(kept_rows);
  if (kept_rows->kind == PreconditionedRows::Kind::penalised_all)
    schedule_.built_for(kept_rows->penalty);
  else
    schedule_.built_for(kept_rows->set, kept_rows->penalty.normal);
}

void ContactPreconditioner::set_up_with(std::span<const double> g, const PreconditionedRows& rows) {
  Space space(*part_);
  const std::vector<NodeBlock> blocks = blocks_for(rows, space);
  current().setup(g, blocks, space);
  if (!factor_) note_first(g);
}

void ContactPreconditioner::change_to(const PreconditionedRows& rows) {
  Space space(*part_);
  const std::vector<NodeBlock> blocks = blocks_for(rows, space);
  current().setup_again(blocks, space);
}

std::vector<NodeBlock> ContactPreconditioner::blocks_for(const PreconditionedRows& rows, Space& space) const {
  if (rows.kind == PreconditionedRows::Kind::penalised_all) return penalty_blocks(rows.penalty);
  const TraceRows held(*part_, rows.set.held);
  std::vector<NodeBlock> blocks;
  const auto add = [&](const std::vector<NodeBlock>& more) {
    blocks.insert(blocks.end(), more.begin(), more.end());
  };
  if (rows.kind == PreconditionedRows::Kind::pinned) {
    held.hold_in(space);
    add(held.pinning_blocks(body_->diagonal()));
  } else {
    add(held.penalty_blocks(rows.penalty.normal));
  }
  add(slip_blocks(*part_, rows.set));
  if (const double loose = rows.penalty.tangential; loose > 0.0) add(penalty_blocks({loose, loose}));
  return blocks;
}

/// Rounded as in a checkpoint, so that a restart sets up with the same bits.
Vector ContactPreconditioner::single_precision_secant() const {
  Vector g = body_->secant();
  for (double& value : g) value = static_cast<double>(static_cast<float>(value));
  return g;
}

/// Returns g in single precision, or empty if it is the elastic one on all ranks. Collective.
ContactPreconditioner::Secant ContactPreconditioner::kept(std::span<const double> g) const {
  if (body_->linear()) return {};
  const Vector elastic = full({});
  if (!part_->node_map.any(!std::equal(g.begin(), g.end(), elastic.begin()))) return {};
  return {g.begin(), g.end()};
}

Vector ContactPreconditioner::full(const Secant& kept) const {
  if (!kept.empty()) return {kept.begin(), kept.end()};
  const Body body = part_->body();
  const std::size_t points = points_per_element(body.mesh.type);
  Vector g(body.secant_count());
  for (std::size_t i = 0; i < g.size(); ++i)
    g[i] = static_cast<double>(static_cast<float>(body.law(i / points).secant(0.0)));
  return g;
}

void ContactPreconditioner::note_first(std::span<const double> g) {
  const int kind = inner_->kind();
  if (!memory_.first || (kind != kind_ && kind_ != made_elsewhere))
    memory_.first = std::make_shared<const Secant>(kept(g));
  kind_ = kind;
}

ContactPreconditioner::Memory ContactPreconditioner::describe() const {
  Memory memory = memory_;
  memory.schedule = schedule_;
  memory.factorised = factor_ != nullptr;
  return memory;
}

ContactPreconditioner::Memory ContactPreconditioner::memory() {
  may_roll_back_ = true;
  had_factor_ = factor_ != nullptr;
  replaced_.reset();
  return describe();
}

void ContactPreconditioner::roll_back(const Memory& memory) {
  memory_ = memory;
  schedule_ = memory.schedule;
  if (!memory.factorised) factor_.reset();
}

ContactPreconditioner::Secant ContactPreconditioner::last_secant() const {
  if (replaced_) return *replaced_;
  if (memory_.rows.empty()) return {};
  Vector g(part_->body().secant_count());
  current().secant(g);
  return kept(g);
}

void ContactPreconditioner::repeat(Memory memory, const Secant& last) {
  const bool to_come = memory.schedule.stale(0.0);  // the next step sets it up in any case
  if (memory.first && !(memory.first->empty() && body_->linear()))
    inner_->setup(full(*memory.first), {}, Space(*part_));
  memory_.first = memory.first;
  kind_ = inner_->kind();
  if (memory.factorised) {
    factor_ = std::make_unique<Factorised>(*part_);
    if (memory.rows.size() > 1) memory.rows.erase(memory.rows.begin(), memory.rows.end() - 1);
  }
  for (std::size_t k = 0; k < memory.rows.size() && !to_come; ++k) {
    if (k == 0)
      set_up_with(full(last), *memory.rows[k]);
    else
      change_to(*memory.rows[k]);
  }
  schedule_ = memory.schedule;
  if (!memory.rows.empty() && memory.rows.back()->kind != PreconditionedRows::Kind::penalised_all)
    schedule_.built_for(memory.rows.back()->set, memory.rows.back()->penalty.normal);
  memory_.rows = std::move(memory.rows);
}

std::vector<NodeBlock> ContactPreconditioner::penalty_blocks(const Penalty& penalty) const {
  const std::size_t points = part_->contact.size();
  auto blocks =
      TraceRows(*part_, std::vector<TraceChoice>(points, {true, false})).penalty_blocks(penalty.normal);
  const auto tangential =
      TraceRows(*part_, std::vector<TraceChoice>(points, {false, true})).penalty_blocks(penalty.tangential);
  blocks.insert(blocks.end(), tangential.begin(), tangential.end());
  return blocks;
}

}  // namespace kacanov
