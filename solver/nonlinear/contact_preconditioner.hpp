// SPDX-License-Identifier: BSD-3-Clause
// The preconditioner of the steps' linear problems, set up when its schedule says that it pays.
#pragma once

#include <cmath>
#include <memory>

#include "linear/preconditioner.hpp"
#include "nonlinear/body_response.hpp"
#include "nonlinear/preconditioner_schedule.hpp"

namespace kacanov {

/// For B + r CᵀMC of ADMM, or B with held rows pinned (theory: multigrid, pinning). Calls are collective.
class ContactPreconditioner {
 public:
  /// `part` and `body` have to outlive it.
  ContactPreconditioner(const Part& part, const BodyResponse& body, std::unique_ptr<Preconditioner> inner,
                        const Tuning& tuning);

  /// z ≈ A⁻¹ r with what it was set up for last.
  void apply(std::span<const double> r, std::span<double> z) { current().apply(r, z); }

  /// With the g that is frozen in the body, whether it pays or not.
  void set_up(const Penalty& penalty);
  /// Before an ADMM step, where it pays; `first`: the elastic one, for which g and penalties are what they
  /// were.
  void prepare(const Penalty& penalty, bool first);
  /// Before a semismooth Newton step with this set, where it pays; so many decimal digits are to be gained.
  void prepare(const ActiveSet& set, double digits);
  /// Before a step that has penalties on the held rows of this set, where it pays; `loose` on all rows.
  void prepare(const ActiveSet& set, double penalty, double loose);
  /// Learns from a solve: decimal digits gained, CG iterations. One of very many ends in factorise().
  void watch(double digits, std::int64_t iterations);
  /// After a solve that has come to nothing: a factor takes over for good where the body is small enough
  /// (theory: factorised). Whether it has, just now; it is still to be prepared.
  bool factorise();
  void mark_stale() noexcept { schedule_.mark_stale(); }

  /// For what sets it up by itself, such as an estimate of the spectrum: it is stale then.
  Preconditioner& lend() noexcept {
    schedule_.mark_stale();
    return *inner_;
  }
  /// As it stands.
  Preconditioner& inner() noexcept { return *inner_; }
  double setup_seconds() const noexcept {
    return inner_->setup_seconds() + (factor_ ? factor_->setup_seconds() : 0.0);
  }

 private:
  /// Whether the g of now pays for a new setup.
  bool worn(double digits = HUGE_VAL) const;
  /// With the g of now if that of the last setup is worn, else with that.
  void build(bool worn, std::span<const NodeBlock> blocks, const Space& space);
  std::vector<NodeBlock> penalty_blocks(const Penalty& penalty) const;
  Preconditioner& current() const noexcept { return factor_ ? *factor_ : *inner_; }

  const Part* part_;
  const BodyResponse* body_;
  std::unique_ptr<Preconditioner> inner_;
  std::unique_ptr<Preconditioner> factor_;  ///< in its place, once that has failed
  Tuning tuning_;
  PreconditionerSchedule schedule_;
  bool friction_;
};

}  // namespace kacanov
