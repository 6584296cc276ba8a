// SPDX-License-Identifier: BSD-3-Clause
// The preconditioner of the steps' linear problems, set up when its schedule says that it pays.
#include "nonlinear/contact_preconditioner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "amg/factorised.hpp"
#include "contact/active_set_step.hpp"
#include "nonlinear/friction_bounds.hpp"

namespace kacanov {

ContactPreconditioner::ContactPreconditioner(const Part& part, const BodyResponse& body,
                                             std::unique_ptr<Preconditioner> inner, const Tuning& tuning)
    : part_(&part),
      body_(&body),
      inner_(std::move(inner)),
      tuning_(tuning),
      schedule_(tuning),
      friction_(has_friction(part)) {}

void ContactPreconditioner::set_up(const Penalty& penalty) {
  build(true, penalty_blocks(penalty), Space(*part_));
  schedule_.built_for(penalty);
}

void ContactPreconditioner::prepare(const Penalty& penalty, bool first) {
  const bool again = first ? schedule_.stale() : worn();
  if (!again && (first || !schedule_.penalty_moved(penalty, friction_))) return;
  build(again, penalty_blocks(penalty), Space(*part_));
  schedule_.built_for(penalty);
}

void ContactPreconditioner::prepare(const ActiveSet& set, double digits) {
  make_room(2 * sizeof(double) * part_->body().secant_count());  // g of now and then
  const bool again = worn(digits);
  if (!again && !part_->node_map.any(schedule_.set_moved(set))) return;
  const TraceRows rows(*part_, set.held);
  Space space(*part_);
  rows.hold_in(space);
  auto blocks = rows.pinning_blocks(body_->diagonal());
  const auto slip = slip_blocks(*part_, set);
  blocks.insert(blocks.end(), slip.begin(), slip.end());
  build(again, blocks, space);
  schedule_.built_for(set);
}

void ContactPreconditioner::prepare(const ActiveSet& set, double penalty, double loose) {
  const bool again = worn();
  if (!again && !part_->node_map.any(schedule_.set_moved(set, penalty))) return;
  auto blocks = TraceRows(*part_, set.held).penalty_blocks(penalty);
  const auto slip = slip_blocks(*part_, set);
  blocks.insert(blocks.end(), slip.begin(), slip.end());
  if (loose > 0.0) {
    const auto all = penalty_blocks({loose, loose});
    blocks.insert(blocks.end(), all.begin(), all.end());
  }
  build(again, blocks, Space(*part_));
  schedule_.built_for(set, penalty);
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

bool ContactPreconditioner::worn(double digits) const {
  if (schedule_.stale(digits)) return true;
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

void ContactPreconditioner::build(bool worn, std::span<const NodeBlock> blocks, const Space& space) {
  if (!worn) return current().setup_again(blocks, space);
  current().setup(body_->secant(), blocks, space);
  schedule_.built();
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
