// SPDX-License-Identifier: BSD-3-Clause
// Preconditioner of linear systems with contact, and the schedule of its setups.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "contact/active_set.hpp"
#include "linear/preconditioner.hpp"
#include "nonlinear/body_response.hpp"
#include "nonlinear/tuning.hpp"

namespace kacanov {

/// Records the state that a preconditioner was set up for and how well it works since, and decides whether a
/// new setup pays off. Independent of the preconditioner itself; all decisions are local to this rank.
class PreconditionerSchedule {
 public:
  explicit PreconditionerSchedule(const Tuning& tuning) : tuning_(tuning) {}

  /// Whether a setup is due in any case: for lack of a first one, or because solving for this many more
  /// decimal digits would lose more iterations than a setup costs.
  bool stale(double digits = HUGE_VAL) const noexcept {
    return stale_ || (lost_per_digit_ > 0.0 && lost_per_digit_ * digits > tuning_.setup_worth);
  }
  void mark_stale() noexcept { stale_ = true; }
  /// Whether g has changed too much since the last setup: sums over all points of |g − g then| and of g then.
  bool drifted(double change, double size) const noexcept { return change > tuning_.drift_worth * size; }
  /// Whether the last setup used penalties that differ too much from these.
  bool penalty_moved(const Penalty& now, bool friction) const;
  /// Whether the last setup used other rows than the set, no set at all, or another penalty (0: pinned rows),
  /// or whether some slip stiffness has changed too much. Every wrong node costs CG a few iterations.
  bool set_moved(const ActiveSet& set, double penalty = 0.0) const;

  /// Records that it was set up with a new g.
  void built();
  void built_for(const Penalty& penalty);
  void built_for(const ActiveSet& set, double penalty = 0.0);
  /// Records the result of a solve: decimal digits gained, and CG iterations. The first solve after a setup
  /// sets the reference; one that exceeds it by the cost of a setup marks the setup as stale.
  void watch(double digits, std::int64_t iterations);

  /// Visits the entries of a checkpoint; built_for() restores the set.
  template <class Visitor>
  void visit(Visitor&& entry) {
    entry("setup_stale", stale_);
    entry("setup_digits_per_cg", digits_per_cg_);
    entry("setup_lost_per_digit", lost_per_digit_);
    entry("setup_penalty_normal", penalty_.normal);
    entry("setup_penalty_tangential", penalty_.tangential);
    entry("setup_held_by", held_by_);
  }

 private:
  bool far(double now, double then) const;

  Tuning tuning_;
  bool stale_ = true;
  double digits_per_cg_ = 0.0;  ///< right after the last setup; 0: unknown
  /// CG iterations per digit of the last solve beyond that reference; 0: too few for a setup.
  double lost_per_digit_ = 0.0;
  Penalty penalty_;
  std::vector<TraceChoice> pinned_;
  Vector slip_stiffness_;
  double held_by_ = 0.0;  ///< penalty of those rows; 0: pinned
};

/// The contact rows that a preconditioner is set up for.
struct PreconditionedRows {
  enum class Kind { penalised_all, pinned, penalised };
  Kind kind = Kind::penalised_all;
  /// Penalty of all rows; for `penalised`, normal is that of the set's rows and tangential that of all rows.
  Penalty penalty;
  ActiveSet set;  ///< only its held rows, slip stiffness and slip direction
};

/// Preconditioner for B + r CᵀMC in ADMM, or B with held rows pinned (theory: multigrid, pinning). Calls are
/// collective.
class ContactPreconditioner {
 public:
  /// `part` and `body` must outlive it.
  ContactPreconditioner(const Part& part, const BodyResponse& body, std::unique_ptr<Preconditioner> inner,
                        const Tuning& tuning);

  /// z ≈ A⁻¹ r with the last setup.
  void apply(std::span<const double> r, std::span<double> z) { current().apply(r, z); }

  /// Sets up unconditionally with the frozen g of the body.
  void set_up(const Penalty& penalty);
  /// Sets up before an ADMM step if it pays off; `first`: the elastic step, for which g and penalties are
  /// unchanged.
  void prepare(const Penalty& penalty, bool first);
  /// Sets up before a semismooth Newton step with this set if it pays off; `digits`: decimal digits still to
  /// gain.
  void prepare(const ActiveSet& set, double digits);
  /// Sets up before a step with penalties on the set's held rows if it pays off; `loose`: penalty on all
  /// rows.
  void prepare(const ActiveSet& set, double penalty, double loose);
  /// Records the result of a solve: decimal digits gained, and CG iterations. A very large number triggers
  /// factorise().
  void watch(double digits, std::int64_t iterations);
  /// After a failed solve: replaces the preconditioner for good by a sparse factor if the body is small
  /// enough (theory: factorised). Returns whether it did so now; the factor is not set up yet.
  bool factorise();
  void mark_stale() noexcept { schedule_.mark_stale(); }

  /// Returns the preconditioner to a caller that sets it up itself, such as a spectrum estimate; marks it as
  /// stale.
  Preconditioner& lend();
  /// Returns the preconditioner in its current state.
  Preconditioner& inner() noexcept { return *inner_; }
  double setup_seconds() const noexcept {
    return inner_->setup_seconds() + (factor_ ? factor_->setup_seconds() : 0.0);
  }

  /// g of a setup, in single precision; empty for an elastic body.
  using Secant = std::vector<float>;
  /// The inputs of its setups, except the g of the last one.
  struct Memory {
    PreconditionerSchedule schedule;
    /// Of the last setup with g, and of every change since.
    std::vector<std::shared_ptr<const PreconditionedRows>> rows;
    std::shared_ptr<const Secant> first;  ///< the g from which aggregates or grids were built; null: none yet
    bool factorised = false;
  };
  /// Returns the current memory; roll_back() to it is possible until the next call.
  Memory memory();
  /// Restores the description in `memory`; afterwards only describe() and last_secant() may be used.
  void roll_back(const Memory& memory);
  /// For a checkpoint: memory() without enabling roll_back(), and the g of the last setup.
  Memory describe() const;
  Secant last_secant() const;
  /// Reproduces the setups of the preconditioner that these describe, bit for bit on the same number of
  /// ranks. Call it before any other member. Collective.
  void repeat(Memory memory, const Secant& last);

 private:
  /// Whether the current g, or the number of row changes, justifies a new setup.
  bool worn(double digits = HUGE_VAL) const;
  /// Sets up with the current g if the last one is worn, else with that of the last setup.
  void build(bool worn, PreconditionedRows rows);
  void set_up_with(std::span<const double> g, const PreconditionedRows& rows);
  void change_to(const PreconditionedRows& rows);
  std::vector<NodeBlock> blocks_for(const PreconditionedRows& rows, Space& space) const;
  std::vector<NodeBlock> penalty_blocks(const Penalty& penalty) const;
  Vector single_precision_secant() const;
  Secant kept(std::span<const double> g) const;
  Vector full(const Secant& kept) const;
  void note_first(std::span<const double> g);
  Preconditioner& current() const noexcept { return factor_ ? *factor_ : *inner_; }

  const Part* part_;
  const BodyResponse* body_;
  std::unique_ptr<Preconditioner> inner_;
  std::unique_ptr<Preconditioner> factor_;  ///< replaces `inner_` after that has failed
  Tuning tuning_;
  Memory memory_;  ///< except its schedule and `factorised`
  static constexpr int made_elsewhere = -1;
  int kind_ = 0;  ///< kind() of `inner_` when `first` was taken
  PreconditionerSchedule schedule_;
  bool friction_;
  bool may_roll_back_ = false, had_factor_ = false;
  /// G of the last setup at the time of memory(), if another one has replaced it.
  std::optional<Secant> replaced_;
};

}  // namespace kacanov
