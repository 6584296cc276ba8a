// SPDX-License-Identifier: BSD-3-Clause
// The preconditioner of the systems with contact, and the schedule of its setups.
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

/// What a preconditioner was set up for, how well it has served since, and whether another would pay. Knows
/// nothing of the preconditioner itself; every question is about this rank.
class PreconditionerSchedule {
 public:
  explicit PreconditionerSchedule(const Tuning& tuning) : tuning_(tuning) {}

  /// Whether it is due whatever else: there is none, or it has served its time, and what it would lose in so
  /// many decimal digits more is worth a setup.
  bool stale(double digits = HUGE_VAL) const noexcept {
    return stale_ || (lost_per_digit_ > 0.0 && lost_per_digit_ * digits > tuning_.setup_worth);
  }
  void mark_stale() noexcept { stale_ = true; }
  /// Whether g is too far from that of the last setup: sums over all points of |g − g then| and of g then.
  bool drifted(double change, double size) const noexcept { return change > tuning_.drift_worth * size; }
  /// Whether it was built with penalties that are far from these.
  bool penalty_moved(const Penalty& now, bool friction) const;
  /// Whether it holds other rows than the set, or none at all, or by another penalty (0: pins them), or
  /// has a slip somewhere that is far stiffer or softer than now. Every node it gets wrong costs CG a few
  /// iterations.
  bool set_moved(const ActiveSet& set, double penalty = 0.0) const;

  /// It was set up with a new g.
  void built();
  void built_for(const Penalty& penalty);
  void built_for(const ActiveSet& set, double penalty = 0.0);
  /// Learns from a solve: decimal digits gained, CG iterations. The first one after a setup is what it can
  /// do; one that needs more than that by what a setup is worth makes it stale.
  void watch(double digits, std::int64_t iterations);

  /// Entries of a checkpoint; the set that it was built for is told by built_for().
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
  double digits_per_cg_ = 0.0;  ///< right after the last setup; 0: not known
  /// CG iterations that the last solve took beyond those, a digit; 0: not worth a setup.
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
  /// Of all rows; where the rows of the set are penalised, theirs, and as `tangential` that of all.
  Penalty penalty;
  ActiveSet set;  ///< its held rows, slip stiffness and slip direction
};

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
  Preconditioner& lend();
  /// As it stands.
  Preconditioner& inner() noexcept { return *inner_; }
  double setup_seconds() const noexcept {
    return inner_->setup_seconds() + (factor_ ? factor_->setup_seconds() : 0.0);
  }

  /// g of a setup, in single precision; of an elastic body empty.
  using Secant = std::vector<float>;
  /// The inputs of its setups, but for the g of the last one.
  struct Memory {
    PreconditionerSchedule schedule;
    /// Of the last setup with g, and of every change since.
    std::vector<std::shared_ptr<const PreconditionedRows>> rows;
    std::shared_ptr<const Secant> first;  ///< the g that aggregates or grids are made of; null: none are
    bool factorised = false;
  };
  /// Of now. roll_back() to it is possible until the next call.
  Memory memory();
  /// Describes what it was; it is of no other use from then on.
  void roll_back(const Memory& memory);
  /// For a checkpoint: memory() without leave to roll back, and the g of the last setup.
  Memory describe() const;
  Secant last_secant() const;
  /// Becomes what another one was that is described by these, on as many ranks to the bit. Before any other
  /// call. Collective.
  void repeat(Memory memory, const Secant& last);

 private:
  /// Whether the g of now, or how often rows have changed, pays for a new setup.
  bool worn(double digits = HUGE_VAL) const;
  /// With the g of now if that of the last setup is worn, else with that.
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
  std::unique_ptr<Preconditioner> factor_;  ///< in its place, once that has failed
  Tuning tuning_;
  Memory memory_;  ///< but for its schedule and `factorised`
  static constexpr int made_elsewhere = -1;
  int kind_ = 0;  ///< of `inner_`, when `first` was taken
  PreconditionerSchedule schedule_;
  bool friction_;
  bool may_roll_back_ = false, had_factor_ = false;
  std::optional<Secant> replaced_;  ///< the last g at the time of memory(),
                                    ///< where there is another now
};

}  // namespace kacanov
