// SPDX-License-Identifier: BSD-3-Clause
// Saves the state of the outer loop to a checkpoint and restores it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "nonlinear/checkpoint_reader.hpp"
#include "nonlinear/outer_loop.hpp"

namespace kacanov {
namespace {

/// Scales the entries stored in the user's units. The others are in the loop's units, which follow from the
/// problem; the load-step history is already in the user's units.
void scale(Checkpoint& checkpoint, const UnitSystem& factors) {
  const std::pair<const char*, double> numbers[] = {
      {"r_star", factors.penalty()},           {"r_active", factors.penalty()},
      {"penalty_normal", factors.penalty()},   {"penalty_tangential", factors.penalty()},
      {"lambda_min", 1.0 / factors.penalty()}, {"lambda_max", 1.0 / factors.penalty()}};
  for (const auto& [name, factor] : numbers)
    if (const auto found = checkpoint.numbers.find(name); found != checkpoint.numbers.end())
      found->second *= factor;
  const std::pair<const char*, double> fields[] = {{"r", factors.penalty()},
                                                   {"displacement", factors.displacement},
                                                   {"pressure", factors.stress()},
                                                   {"friction", factors.stress()},
                                                   {"bound", factors.stress()},
                                                   {"phi_normal", factors.displacement},
                                                   {"phi_tangential", factors.displacement},
                                                   {"slip_origin", factors.displacement}};
  for (const auto& [name, factor] : fields)
    if (const auto found = checkpoint.fields.find(name); found != checkpoint.fields.end())
      for (double& value : found->second) value *= factor;
}

bool same(const ContactState& a, const ContactState& b) {
  return a.u == b.u && a.lambda.normal == b.lambda.normal && a.lambda.tangential == b.lambda.tangential &&
         a.phi.normal == b.phi.normal && a.phi.tangential == b.phi.tangential && a.bound == b.bound;
}

/// Splits the vector of multipliers of AugmentedControl: normal values first, then tangential ones.
ContactValues parted(const Vector& joined) {
  ContactValues values(joined.size() / 3);
  const auto middle = joined.begin() + static_cast<std::ptrdiff_t>(values.normal.size());
  std::copy(joined.begin(), middle, values.normal.begin());
  std::copy(middle, joined.end(), values.tangential.begin());
  return values;
}

/// Held rows take two bits per setup, and a double holds 53 bits exactly.
constexpr std::size_t setups_in_a_number = 26;

/// Collects the data of all ranks in a checkpoint on the first rank. Collective.
class CheckpointWriter {
 public:
  CheckpointWriter(const Part& part, Checkpoint& out) : part_(part), out_(out) {}

  template <class Value>
  void operator()(const std::string& name, const Value& value) const {
    out_.numbers[name] = static_cast<double>(value);
  }
  void contact(const std::string& name, const Vector& values, int components) const {
    out_.fields[name] = gather_contact(part_, values, components);
  }
  void state(const std::string& prefix, const ContactState& state) const {
    out_.fields[prefix + "displacement"] = gather_nodal(part_, state.u, part_.dim());
    contact(prefix + "pressure", state.lambda.normal, 1);
    contact(prefix + "friction", state.lambda.tangential, 2);
    contact(prefix + "phi_normal", state.phi.normal, 1);
    contact(prefix + "phi_tangential", state.phi.tangential, 2);
    contact(prefix + "bound", state.bound, 1);
  }
  void place(const std::string& name, const OuterLoop::Place& place) const {
    (*this)(name + "_share", place.share);
    (*this)(name + "_at_rest", place.at_rest);
    if (!place.at_rest) state(name + "_", place.state);
  }
  void multipliers(const std::string& name, const Vector& joined) const {
    const ContactValues values = parted(joined);
    contact(name + "_normal", values.normal, 1);
    contact(name + "_tangential", values.tangential, 2);
  }
  void secant(const std::string& name, const ContactPreconditioner::Secant& g) const {
    const bool elastic = !part_.node_map.any(!g.empty());
    (*this)(name, !elastic);
    if (!elastic) out_.fields[name] = gather_elements(part_, Vector(g.begin(), g.end()), each());
  }
  void preconditioner(ContactPreconditioner::Memory memory, const ContactPreconditioner::Secant& last) const {
    // If a setup is due, the previous one is irrelevant.
    const bool due = memory.schedule.stale(0.0);
    if (due) memory.rows.clear();
    memory.schedule.visit(*this);
    (*this)("setup_factorised", memory.factorised);
    (*this)("setup_made", memory.first != nullptr);
    if (memory.first) secant("setup_first", *memory.first);
    if (!due) secant("setup_last", last);
    (*this)("setup_rows", memory.rows.size());
    const std::size_t points = part_.contact.size();
    for (std::size_t begin = 0; begin < memory.rows.size(); begin += setups_in_a_number) {
      Vector held(points, 0.0);
      for (std::size_t k = std::min(begin + setups_in_a_number, memory.rows.size()); k-- > begin;) {
        const auto& choice = memory.rows[k]->set.held;
        for (std::size_t i = 0; i < choice.size(); ++i)
          held[i] = 4.0 * held[i] + (choice[i].normal ? 1.0 : 0.0) + (choice[i].tangential ? 2.0 : 0.0);
      }
      contact("setup_held_" + std::to_string(begin / setups_in_a_number), held, 1);
    }
    for (std::size_t k = 0; k < memory.rows.size(); ++k) rows(std::to_string(k), *memory.rows[k]);
  }

 private:
  int each() const { return static_cast<int>(points_per_element(part_.type)); }
  void rows(const std::string& number, const PreconditionedRows& rows) const {
    (*this)("setup_kind_" + number, static_cast<int>(rows.kind));
    (*this)("setup_normal_" + number, rows.penalty.normal);
    (*this)("setup_tangential_" + number, rows.penalty.tangential);
    const Vector& stiffness = rows.set.slip_stiffness;
    const bool slips = part_.node_map.any(
        std::any_of(stiffness.begin(), stiffness.end(), [](double k) { return k != 0.0; }));
    (*this)("setup_slips_" + number, slips);
    if (!slips) return;
    contact("setup_stiffness_" + number, stiffness, 1);
    contact("setup_direction_" + number, rows.set.slip_direction, 2);
  }

  const Part& part_;
  Checkpoint& out_;
};

/// Reads the loop's state from a checkpoint.
class LoopReader : public CheckpointReader {
 public:
  using CheckpointReader::CheckpointReader;
  static constexpr double largest_share = 1e300;

  void state(const std::string& prefix, ContactState& state) const {
    state.u = nodal(prefix + "displacement");
    state.lambda.normal = contact(prefix + "pressure", 1);
    state.lambda.tangential = contact(prefix + "friction", 2);
    state.phi.normal = contact(prefix + "phi_normal", 1);
    state.phi.tangential = contact(prefix + "phi_tangential", 2);
    state.bound = contact(prefix + "bound", 1);
  }
  /// `rest`: the place at rest, with its gaps and slip origins.
  OuterLoop::Place place(const std::string& name, OuterLoop::Place rest) const {
    rest.share = within(name + "_share", 0.0, largest_share);
    (*this)(name + "_at_rest", rest.at_rest);
    if (!rest.at_rest) state(name + "_", rest.state);
    return rest;
  }
  void multipliers(const std::string& name, Vector& joined) const {
    joined = contact(name + "_normal", 1);
    const Vector tangential = contact(name + "_tangential", 2);
    joined.insert(joined.end(), tangential.begin(), tangential.end());
  }
  ContactPreconditioner::Secant secant(const std::string& name) const {
    if (!number<bool>(name)) return {};
    const auto each = static_cast<int>(points_per_element(part_.type));
    const Vector g = elements(name, each);
    return {g.begin(), g.end()};
  }
  /// Reads the preconditioner's memory; the caller has constructed its schedule.
  void preconditioner(ContactPreconditioner::Memory& memory, ContactPreconditioner::Secant& last) const {
    memory.schedule.visit(*this);
    (*this)("setup_factorised", memory.factorised);
    if (number<bool>("setup_made"))
      memory.first = std::make_shared<const ContactPreconditioner::Secant>(secant("setup_first"));
    if (!memory.schedule.stale(0.0)) last = secant("setup_last");
    const std::size_t count = length("setup_rows", 1000);
    Vector held;
    for (std::size_t k = 0; k < count; ++k) {
      if (k % setups_in_a_number == 0)
        held = contact("setup_held_" + std::to_string(k / setups_in_a_number), 1);
      memory.rows.push_back(std::make_shared<const PreconditionedRows>(rows(std::to_string(k), held)));
    }
  }

 private:
  /// Reads the rows of one setup and removes their two bits from each entry of `held`.
  PreconditionedRows rows(const std::string& number, Vector& held) const {
    PreconditionedRows out;
    const std::size_t kind = length("setup_kind_" + number, 2);
    out.kind = static_cast<PreconditionedRows::Kind>(kind);
    (*this)("setup_normal_" + number, out.penalty.normal);
    (*this)("setup_tangential_" + number, out.penalty.tangential);
    out.set = ActiveSet(out.kind == PreconditionedRows::Kind::penalised_all ? 0 : held.size());
    for (std::size_t i = 0; i < held.size(); ++i) {
      const auto bits = static_cast<unsigned>(std::fmod(std::abs(held[i]), 4.0));
      held[i] = std::floor(held[i] / 4.0);
      if (i < out.set.held.size()) out.set.held[i] = {(bits & 1U) != 0, (bits & 2U) != 0};
    }
    if (!this->number<bool>("setup_slips_" + number)) return out;
    out.set.slip_stiffness = contact("setup_stiffness_" + number, 1);
    out.set.slip_direction = contact("setup_direction_" + number, 2);
    return out;
  }
};

}  // namespace

bool OuterLoop::stop_agreed() const {
  return context_.part.node_map.any(run_.stop_requested && run_.stop_requested());
}

void OuterLoop::keep(const Result& result) {
  if (stoppable_) {
    kept_ = Kept{context_.state,         control_, result,  context_.preconditioner.memory(),
                 context_.body.frozen(), opening_, adopted_};
    if (stop_agreed()) throw Interrupted{};
  }
  if (result.outer_iterations == 0) return;
  const double before = MPI_Wtime();
  const Communicator& ranks = context_.part.node_map;
  const bool due = ranks.rank == 0 && run_.checkpoint && (!run_.checkpoint_due || run_.checkpoint_due());
  if (!ranks.any(due)) return;
  const Checkpoint all = checkpoint(result);
  if (due) run_.checkpoint(all);
  checkpoint_seconds_ += MPI_Wtime() - before;
}

bool OuterLoop::run(Result& result) {
  try {
    iterate(result);
  } catch (const Interrupted&) {
    context_.state = kept_->state;
    control_ = kept_->control;
    result = kept_->result;
    context_.preconditioner.roll_back(kept_->preconditioner);
    opening_ = kept_->opening;
    adopted_ = kept_->adopted;
    stopped_ = true;
    return false;
  }
  return true;
}

Checkpoint OuterLoop::checkpoint(const Result& result) const {
  const Part& part = context_.part;
  const ContactState& state = context_.state;
  Checkpoint out;
  const CheckpointWriter put(part, out);
  Result counted = result;
  visit_counts(counted, put);
  Control control = control_;
  control.fallback.visit(put);
  control.linearisation.visit(put);
  control.augmented.visit(put, [&](const std::string& name, Vector& all) { put.multipliers(name, all); });
  put("operator_applications", applications());
  put("penalty_rule", options_.penalty);
  put("penalty_normal", control.penalty.value().normal);
  put("penalty_tangential", control.penalty.value().tangential);
  put("load_steps_over", result.load_steps.size());
  out.fields["r"] = result.r;
  out.fields["load_steps"] = numbers_of(result.load_steps);
  put.state("", state);
  if (history_) {
    Vector origin = state.origin;
    origin.resize(2 * state.bound.size(), 0.0);
    put.contact("slip_origin", origin, 2);
  }
  put("opening", opening_);
  put("adopted", adopted_);
  put("coarse_lambda_max", coarse_lambda_max_);
  put("within", within_);
  put("frozen_here", frozen().here);
  put("frozen_elastic", frozen().elastic);
  const bool good = best_.worst < HUGE_VAL, elsewhere = part.node_map.any(good && !same(best_.state, state));
  put("best_worst", best_.worst);
  put("best_by_multipliers", best_.by_multipliers);
  put("best_elsewhere", elsewhere);
  if (elsewhere) put.state("best_", best_.state);
  put("cut", parts.cut);
  put("started", parts.start.has_value());
  if (parts.start && !parts.cut) put.place("start", *parts.start);
  if (parts.cut) {
    put("start_share", parts.start ? parts.start->share : 0.0);
    put.place("last", parts.last);
    if (parts.last.at_rest) put.place("whole", parts.whole);
    for (const auto& [name, value] :
         {std::pair{"parts_over", parts.over}, std::pair{"parts_part", parts.part},
          std::pair{"parts_next", parts.next}})
      put(name, value);
    put("parts_again", parts.again);
  }
  const ContactPreconditioner& preconditioner = context_.preconditioner;
  put.preconditioner(preconditioner.describe(), preconditioner.last_secant());
  scale(out, units_);
  return out;
}

void OuterLoop::restore(const Checkpoint* users, Result& result) {
  const Part& part = context_.part;
  Checkpoint own;
  if (part.node_map.rank == 0) {
    own = *users;
    scale(own, units_.inverse());
  }
  const LoopReader get(part, &own);
  visit_counts(result, get);
  control_.fallback.visit(get);
  control_.linearisation.visit(get);
  get("operator_applications", earlier_applications_);
  restore_penalty(get.number<double>("penalty_rule"),
                  {get.number<double>("penalty_normal"), get.number<double>("penalty_tangential")}, result);
  result.restarted_after = result.outer_iterations;
  first_outer_ = result.outer_iterations;  // a restart allows max_outer further steps
  std::size_t steps = 0;
  get("load_steps_over", steps);
  result.load_steps = get.load_steps("load_steps", steps);
  result.r = get.values("r", result.outer_iterations);

  ContactState& state = context_.state;
  get.state("", state);
  if (history_) state.origin = get.contact("slip_origin", 2);
  control_.augmented.visit(get, [&](const std::string& name, Vector& all) { get.multipliers(name, all); });
  get("opening", opening_);
  get("adopted", adopted_);
  get("coarse_lambda_max", coarse_lambda_max_);
  get("within", within_);
  const Place rest = this->rest();
  get("cut", parts.cut);
  if (get.number<bool>("started"))
    parts.start = parts.cut ? Place{rest.state, get.within("start_share", 0.0, LoopReader::largest_share)}
                            : get.place("start", rest);
  if (parts.cut) {
    parts.last = get.place("last", rest);
    if (parts.last.at_rest) parts.whole = get.place("whole", rest);
    parts.over = get.within("parts_over", 0.0, 1.0);
    parts.part = get.within("parts_part", 0.0, 1.0);
    parts.next = get.within("parts_next", 0.0, 1.0);
    get("parts_again", parts.again);
    stand_in_parts();
  }
  state.gap = context_.path.gap();
  state.evaluate(context_.traces);
  get("best_worst", best_.worst);
  get("best_by_multipliers", best_.by_multipliers);
  best_.state = state;
  if (get.number<bool>("best_elsewhere")) {
    get.state("best_", best_.state);
    best_.state.evaluate(context_.traces);
  }
  const BodyResponse::Frozen frozen{within_ && get.number<bool>("frozen_here"),
                                    get.number<bool>("frozen_elastic")};
  context_.body.resume(state.u, frozen);
  ContactPreconditioner::Memory memory = context_.preconditioner.describe();
  ContactPreconditioner::Secant last;
  get.preconditioner(memory, last);
  context_.preconditioner.repeat(std::move(memory), last);
  resumes_ = true;
}

/// If the user has selected another rule or value, it replaces the penalty of the checkpoint.
void OuterLoop::restore_penalty(double rule, Penalty penalty, const Result& result) {
  const bool by_user = options_.penalty == SolverOptions::Penalty::fixed;
  if (rule != static_cast<double>(options_.penalty) || (by_user && penalty.normal != options_.r))
    penalty = {};
  control_.penalty.restore(penalty, result.lambda_min);
}

/// Sets the load of the current part of the load step.
void OuterLoop::stand_in_parts() {
  const double from = step_begin(), whole = context_.path.share();
  context_.path.go_to(parts.next == 1.0 ? whole : from + parts.next * (whole - from));
  context_.take_temperature();
}

}  // namespace kacanov
