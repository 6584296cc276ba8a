// SPDX-License-Identifier: BSD-3-Clause
// Solver for obstacles that move, are pushed by a force, or are relinearised at each load step.
#include <kacanov/solve.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/part.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "moving/obstacle_motion.hpp"
#include "nonlinear/checkpoint_reader.hpp"
#include "nonlinear/load_steps.hpp"
#include "partition/global_max.hpp"
#include "problem/contact_points.hpp"
#include "problem/vector3.hpp"

namespace kacanov {

/// Sets the rows, gaps and slip origins of a part for the position of its obstacles at a time (theory:
/// moving-obstacles). All members are collective.
class MovingContact {
 public:
  /// `part` and `model` must outlive it.
  MovingContact(Part& part, const Model& model);

  /// Sets the contact at the end `time` of a load step that began at `before` with the displacement u. Pushed
  /// entries stay where push() left them.
  void face(double time, double before, std::span<const double> u);
  /// Sets the travel of a pushed entry along its direction, relative to its position in the case file.
  void push(std::size_t entry, double travel);
  /// Moves a pushed entry with zero force in this load step out of contact. The next step measures its travel
  /// from the position in the case file.
  void withdraw(std::size_t entry);
  /// Returns the smallest travel at which a pushed entry, as last linearised, reaches any node at u = 0; 0 if
  /// no node is in its way.
  double touch(std::size_t entry) const;

  static Vector3 direction(const ContactEntry& entry);

  /// For a checkpoint: travel of each entry at the last call of face(); resume() restores it, so that face()
  /// can be called in the same way.
  std::span<const double> faced_at() const noexcept { return faced_at_; }
  void resume(std::span<const double> faced_at) { travel_.assign(faced_at.begin(), faced_at.end()); }

 private:
  struct View;
  View view(const ContactEntry& entry, const SurfacePoint& at, const Vector3& u,
            const std::array<double, 2>& times, double travel) const;
  /// Measures the slip of a point with a fixed obstacle from u, the end of the previous load step.
  void count_from(std::size_t i, std::span<const double> u);
  /// Sets normal and gap of a point from the view of its obstacle, and returns its row. If the obstacle is
  /// out of reach or the node can hardly move towards it, returns nothing and sets an unreachable gap; the
  /// point then keeps its row of the case.
  std::optional<RowEntry> take(std::size_t i, const View& view, std::span<const double> u,
                               ContactPoint& point);

  std::optional<RowEntry> row_along(const Vector3& normal, ContactPoint& point) const;

  Part& part_;
  const Model& model_;
  const ConstraintRows there_;  ///< as in the case file
  double far_;
  /// Per entry of the model: current travel, and that at the last face().
  std::vector<double> travel_, faced_at_;
  std::vector<double> gap_;      ///< per point: at the last face()
  std::vector<Vector3> origin_;  ///< displacement from which slip is measured, at the last face()
};

/// Relative rounding error of a sum of lengths.
constexpr double some_roundings = 1e-15;

/// Projection of a node onto an obstacle that has moved.
struct MovingContact::View {
  Vector3 normal{};
  double gap = 0.0;
  Vector3 carried{}, step{};  ///< motion of the obstacle's touched point: in total, in this load step
  double unknown = 0.0;       ///< rounding error of the gap
  double kind = 0.0;          ///< 0 in contact range, 1 out of reach, 2 undecided
  static constexpr int numbers = 12;
};

MovingContact::MovingContact(Part& part, const Model& model)
    : part_(part),
      model_(model),
      there_(part.contact),
      far_(10.0 * body_extent(part)),
      travel_(model.contact.size()),
      faced_at_(model.contact.size()),
      gap_(part.contact.size()),
      origin_(part.contact.size()) {}

Vector3 MovingContact::direction(const ContactEntry& entry) {
  const Vector3& d = entry.force_controlled->direction;
  return (1.0 / norm(d)) * d;
}

MovingContact::View MovingContact::view(const ContactEntry& entry, const SurfacePoint& at, const Vector3& u,
                                        const std::array<double, 2>& times, double travel) const {
  const Vector3& x = at.x;
  RigidPose start, now;
  if (entry.motion) {
    start = RigidPose::at(*entry.motion, times[0]);
    now = RigidPose::at(*entry.motion, times[1]);
  } else if (entry.force_controlled) {
    start.shift = now.shift = travel * direction(entry);
  }
  // With relinearisation the node is where the previous step has left it, and the obstacle at its current
  // position. Otherwise both are as in the case file, and the touched point moves with the obstacle.
  const Vector3 seen = entry.relinearise ? now.back(x + u) : x;
  const Vector3 outer = entry.relinearise ? now.turned(at.outer, -1.0) : at.outer;
  const Facing facing = std::visit(
      [&](const auto& kind) {
        return kind.project({seen, outer});
      },
      entry.obstacle);
  if (facing.kind == Facing::Kind::missed) return {{}, far_, {}, {}, 0.0, 1.0};
  if (facing.kind == Facing::Kind::undecided) return {{}, 0.0, {}, {}, 0.0, 2.0};
  const Vector3 foot = seen + facing.gap * facing.normal;
  View view;
  view.carried = now.carried(foot);
  view.step = view.carried - start.carried(foot);
  const double turned = std::min(norm(now.rotation), 2.0) * norm(foot - now.centre);
  view.unknown = facing.unknown + some_roundings * (norm(now.shift) + turned);
  if (entry.relinearise) {
    view.unknown += some_roundings * (norm(x) + norm(u) + norm(now.centre));
    view.normal = now.turned(facing.normal);
    view.gap = facing.gap + dot(view.normal, u);
  } else {
    view.normal = facing.normal;
    view.gap = facing.gap + dot(view.normal, view.carried);
  }
  return view;
}

void MovingContact::face(double time, double before, std::span<const double> u) {
  const std::size_t dim = part_.dim(), points = part_.contact.size();
  const auto at = [dim](std::span<const double> values, std::int32_t node) {
    Vector3 v{};
    for (std::size_t c = 0; c < dim; ++c) v[c] = values[node * dim + c];
    return v;
  };
  constexpr std::size_t numbers = 10;
  std::vector<double> local;
  for (const ContactPoint& point : part_.contact) {
    const Vector3 x = at(part_.coordinates, point.node), moved = at(u, point.node);
    local.push_back(static_cast<double>(point.entry));
    local.insert(local.end(), x.begin(), x.end());
    local.insert(local.end(), moved.begin(), moved.end());
    const ContactPoint& there = there_[local.size() / numbers];
    // Of equally near faces, one that follows the body keeps its direction; else the choice is that at rest.
    const Vector3& outer = model_.contact[point.entry].relinearise ? there.normal : there.outer;
    local.insert(local.end(), outer.begin(), outer.end());
  }
  const std::vector<double> all = gather_contact(part_, local, numbers);
  std::vector<double> views;
  for (std::size_t i = 0; numbers * i < all.size(); ++i) {
    const double* p = &all[numbers * i];
    const auto index = static_cast<std::size_t>(p[0]);
    const ContactEntry& entry = model_.contact[index];
    View v;
    if (entry.moves())
      v = view(entry, {{p[1], p[2], p[3]}, {p[7], p[8], p[9]}}, {p[4], p[5], p[6]}, {before, time},
               travel_[index]);
    for (const Vector3* vector : {&v.normal, &v.carried, &v.step})
      views.insert(views.end(), vector->begin(), vector->end());
    views.insert(views.end(), {v.gap, v.unknown, v.kind});
  }
  views = scatter_contact(part_, views, View::numbers);
  double lost = 0.0;  // contact entry, counted from 1, with a node that has no contact direction
  for (std::size_t i = 0; i < points; ++i)
    if (views[View::numbers * i + 11] == 2.0) lost = static_cast<double>(part_.contact[i].entry) + 1.0;
  lost = part_.node_map.max_all(lost);
  if (lost > 0.0)
    throw InputError("contact[" + std::to_string(static_cast<int>(lost) - 1) +
                     "].obstacle: a node has come to lie where no direction leads out of the obstacle");
  faced_at_ = travel_;
  // Rows are rebuilt because they cannot be modified in place.
  ConstraintRows rows;
  part_.slip_origin.assign(2 * points, 0.0);
  for (std::size_t i = 0; i < points; ++i) {
    const double* p = &views[View::numbers * i];
    const View v{{p[0], p[1], p[2]}, p[9], {p[3], p[4], p[5]}, {p[6], p[7], p[8]}, p[10], p[11]};
    ContactPoint there = there_[i], point = there;
    const bool moves = model_.contact[point.entry].moves();
    if (!moves && point.since_step) count_from(i, u);
    const auto row = moves ? take(i, v, u, point) : std::nullopt;
    if (moves) there.tresca = 0.0;  // out of reach, Tresca friction does not act either
    if (row)
      rows.push_back(point, {&*row, 1});
    else
      rows.push_back(there, there_.entries(i));
  }
  part_.contact = std::move(rows);
  for (std::size_t e = 0; e < model_.contact.size(); ++e)
    if (model_.contact[e].moves()) push(e, travel_[e]);
}

void MovingContact::count_from(std::size_t i, std::span<const double> u) {
  const std::size_t dim = part_.dim();
  for (const RowEntry& entry : there_.entries(i))
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t c = 0; c < dim; ++c)
        part_.slip_origin[2 * i + k] +=
            entry.tangent[k][c] * u[static_cast<std::size_t>(entry.node) * dim + c];
}

std::optional<RowEntry> MovingContact::take(std::size_t i, const View& view, std::span<const double> u,
                                            ContactPoint& point) {
  const std::size_t dim = part_.dim(), base = point.node * dim;
  gap_[i] = far_;
  origin_[i] = {};
  if (view.kind != 0.0) return std::nullopt;
  const auto row = row_along(view.normal, point);
  if (!row) return std::nullopt;
  gap_[i] = view.gap;
  point.unknown_gap = view.unknown;
  origin_[i] = view.carried;
  if (point.since_step) {
    origin_[i] = view.step;
    for (std::size_t c = 0; c < dim; ++c) origin_[i][c] += u[base + c];
  }
  return row;
}

std::optional<RowEntry> MovingContact::row_along(const Vector3& normal, ContactPoint& point) const {
  const std::size_t dim = part_.dim(), base = point.node * dim;
  NodeFreedom freedom;
  for (std::size_t c = 0; c < dim; ++c) freedom.free[c] = part_.held[base + c] == 0;
  freedom.held = directions_of(part_.directions, point.node);
  point.normal = normal;
  return narrow_row(point, freedom, point.tresca > 0.0 || point.coulomb > 0.0);
}

void MovingContact::push(std::size_t entry, double travel) {
  const ContactEntry& pushed = model_.contact[entry];
  travel_[entry] = travel;
  const Vector3 way = pushed.force_controlled ? (travel - faced_at_[entry]) * direction(pushed) : Vector3{};
  const std::size_t dim = part_.dim();
  for (std::size_t i = 0; i < part_.contact.size(); ++i) {
    ContactPoint& point = part_.contact[i];
    if (static_cast<std::size_t>(point.entry) != entry) continue;
    point.gap = gap_[i];
    if (gap_[i] != far_) point.gap += dot(point.normal, way);
    for (std::size_t c = 0; c < dim; ++c) {
      const std::size_t k = point.node * dim + c;
      if (part_.held[k] != 0)
        point.gap -= point.normal[c] * part_.prescribed[part_.prescribed_place(k)].value;
    }
    for (const HeldDirection& held : directions_of(part_.directions, point.node))
      point.gap -= dot(point.normal, held.direction) * held.value;
    for (int k = 0; k < point.tangents; ++k)
      part_.slip_origin[2 * i + static_cast<std::size_t>(k)] = dot(point.tangent[k], origin_[i] + way);
  }
}

void MovingContact::withdraw(std::size_t entry) {
  for (std::size_t i = 0; i < part_.contact.size(); ++i)
    if (static_cast<std::size_t>(part_.contact[i].entry) == entry) {
      gap_[i] = far_;
      part_.contact[i].tresca = 0.0;
    }
  push(entry, 0.0);
}

double MovingContact::touch(std::size_t entry) const {
  const Vector3 d = direction(model_.contact[entry]);
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    const ContactPoint& point = part_.contact[i];
    const double closing = -dot(point.normal, d);
    if (static_cast<std::size_t>(point.entry) != entry || gap_[i] == far_ || closing < 0.1) continue;
    least = std::min(least, gap_[i] / closing);
  }
  least = -part_.node_map.max_all(-least);
  return faced_at_[entry] + (std::isfinite(least) ? least : 0.0);
}

namespace {

/// Adds counts and times of the previous solves to those of one solve.
void add(Result& result, const Result& before) {
  const auto add_all = [](auto& sum, const auto& more, auto... entries) {
    ((sum.*entries += more.*entries), ...);
  };
  add_all(result, before, &Result::outer_iterations, &Result::cg_iterations, &Result::contact_iterations,
          &Result::unsolved_steps, &Result::load_cuts, &Result::operator_applications,
          &Result::spectrum_applications, &Result::contact_applications);
  add_all(result.seconds, before.seconds, &PhaseSeconds::total, &PhaseSeconds::prepare,
          &PhaseSeconds::spectrum, &PhaseSeconds::preconditioner_setup, &PhaseSeconds::solve,
          &PhaseSeconds::checkpoint, &PhaseSeconds::certificate);
  result.r.insert(result.r.begin(), before.r.begin(), before.r.end());
  std::vector<std::string> warnings = before.warnings;
  for (std::string& warning : result.warnings)
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
      warnings.push_back(std::move(warning));
  result.warnings = std::move(warnings);
  if (result.restarted_after >= 0)
    result.restarted_after += before.outer_iterations;
  else
    result.restarted_after = before.restarted_after;
}

/// Visits the counts that a checkpoint stores.
template <class R, class Visitor>
void visit_sums(R& result, Visitor&& entry) {
  entry("before_outer", result.outer_iterations);
  entry("before_cg", result.cg_iterations);
  entry("before_contact", result.contact_iterations);
  entry("before_unsolved", result.unsolved_steps);
  entry("before_cuts", result.load_cuts);
  entry("before_applications", result.operator_applications);
  entry("before_spectrum", result.spectrum_applications);
  entry("before_contact_applications", result.contact_applications);
}

/// The sequence of solves of a run, each starting from the end of the previous one.
class Chain {
 public:
  Chain(Part& part, const Model& model, const RunOptions& run)
      : part_(part),
        model_(model),
        run_(run),
        contact_(part, model),
        curves_(part.steps),
        extent_(body_extent(part)) {
    over_ = std::move(run_.load_step_over);
    run_.load_step_over = nullptr;
    checkpoints_ = part.node_map.any(static_cast<bool>(run_.checkpoint));
    if (!run_.coarse.empty() && !run_.coarse[0].at_rest()) start_ = interpolate(run_.coarse[0], part);
    run_.coarse = {};
    u_.assign(part.unknowns(), 0.0);
    for (std::size_t e = 0; e < model.contact.size(); ++e)
      if (model.contact[e].force_controlled) pushed_.push_back({e, {}});
  }

  Solution run() {
    step_ = 1;
    resumes_ = part_.node_map.any(part_.node_map.rank == 0 && run_.start != nullptr);
    if (resumes_) resume();
    for (; step_ < curves_.size(); ++step_) {
      const std::size_t k = step_;
      const double time = curves_[k].time;
      // The load may be cut between the two points.
      part_.steps = {still(curves_[k - 1]), still(curves_[k])};
      if (curves_.size() > 2)
        tell(load_step_name(k - 1, curves_.size() - 1, !model_.steps_are_factors, time));
      contact_.face(time, curves_[k - 1].time, u_);
      if (forces_.empty()) {
        outer_ = last_.result.outer_iterations;
        cg_ = last_.result.cg_iterations;
        searched_from_.clear();
        for (const Pushed& pushed : pushed_) searched_from_.push_back(pushed.search.travel);
      }
      const bool arrived = push_all(curves_[k].contact);
      forces_.clear();
      told_ = 0;
      u_ = last_.displacement;
      const Result& result = last_.result;
      if (!result.load_steps.empty()) {
        LoadStep line = result.load_steps.back();
        line.outer_iterations = result.outer_iterations - outer_;
        line.cg_iterations = result.cg_iterations - cg_;
        for (const ContactTotals& contact : result.contact) line.travel.push_back(contact.travel);
        lines_.push_back(line);
      }
      if (arrived)
        reached_ = time;
      else if (!pushes_ && result.load_reached > 0.0)  // by part of the step
        reached_ = result.load_reached;
      if (!arrived) {
        end_early(k, time);
        break;
      }
      if (over_ && k + 1 < curves_.size()) {
        last_.result.load_steps = lines_;
        last_.result.by_time = !model_.steps_are_factors;
        over_(part_, last_);
      }
    }
    last_.result.load_steps = std::move(lines_);
    last_.result.by_time = !model_.steps_are_factors;
    last_.result.load_reached = reached_;
    return std::move(last_);
  }

 private:
  /// Returns the factors with 1 for moving obstacles, which their factors do not withdraw.
  LoadFactors still(LoadFactors factors) const {
    for (std::size_t e = 0; e < factors.contact.size(); ++e)
      if (model_.contact[e].moves()) factors.contact[e] = 1.0;
    return factors;
  }

  void tell(const std::string& stage) const {
    if (run_.stage && part_.node_map.rank == 0) run_.stage(stage);
  }

  /// Solves from the end of the last solve; counts, times and warnings accumulate.
  void solve_once() {
    // After a restart the search is repeated with the stored forces of the solves before it.
    if (told_ < forces_.size()) {
      ++told_;
      return;
    }
    const Result before = std::move(last_.result);
    RunOptions run = run_;
    run.from = start_.displacement.empty() ? nullptr : &start_;
    if (!resumes_) run.start = nullptr;
    resumes_ = false;
    const Checkpoint own = checkpoints_ ? checkpoint(before) : Checkpoint();
    if (run_.checkpoint)
      run.checkpoint = [&](Checkpoint all) {
        all.numbers.insert(own.numbers.begin(), own.numbers.end());
        all.fields.insert(own.fields.begin(), own.fields.end());
        run_.checkpoint(all);
      };
    if (run_.progress)
      run.progress = [&](ProgressStep step) {
        step.outer += before.outer_iterations;
        step.seconds += before.seconds.total;
        run_.progress(step);
      };
    last_ = solve(part_, model_.solver, run);
    add(last_.result, before);
    start_.displacement = last_.displacement;
    start_.pressure = last_.pressure;
    start_.friction.assign(2 * part_.contact.size(), 0.0);
    for (std::size_t i = 0; i < part_.contact.size(); ++i)
      for (int k = 0; k < part_.contact[i].tangents; ++k)
        start_.friction[2 * i + static_cast<std::size_t>(k)] =
            -dot(last_.traction[i], part_.contact[i].tangent[k]);
    start_.lambda_max = last_.result.lambda_max;
    forces_.emplace_back();
    for (const Pushed& pushed : pushed_)
      forces_.back().push_back(dot(last_.result.contact[pushed.entry].total.force,
                                   MovingContact::direction(model_.contact[pushed.entry])));
    told_ = forces_.size();
  }

  /// Returns on the first rank the completed load steps and solves before the current one; `before` contains
  /// their counts. Collective.
  Checkpoint checkpoint(const Result& before) const {
    Checkpoint out;
    const auto put = [&](const char* name, const auto& value) {
      out.numbers[name] = static_cast<double>(value);
    };
    visit_sums(before, put);
    put("moving_step", step_);
    put("moving_reached", reached_);
    put("moving_outer", outer_);
    put("moving_cg", cg_);
    put("moving_steps_over", lines_.size());
    put("moving_solves", forces_.size());
    for (const std::vector<double>& force : forces_)
      out.fields["moving_forces"].insert(out.fields["moving_forces"].end(), force.begin(), force.end());
    if (forces_.empty()) out.fields["moving_forces"] = {};
    out.fields["moving_searched_from"] = searched_from_;
    out.fields["moving_faced_at"] = {contact_.faced_at().begin(), contact_.faced_at().end()};
    out.fields["moving_load_steps"] = numbers_of(lines_);
    out.fields["before_r"] = before.r;
    out.fields["moving_displacement"] = gather_nodal(part_, u_, part_.dim());
    return out;
  }

  /// Restores the state from a checkpoint. Collective.
  void resume() {
    const CheckpointReader get(part_, run_.start);
    Result& before = last_.result;
    visit_sums(before, get);
    before.r = get.values("before_r", static_cast<std::size_t>(before.outer_iterations));
    before.status = Status::converged;
    step_ = get.length("moving_step", static_cast<std::int64_t>(curves_.size()) - 1);
    if (step_ == 0) throw InputError("the checkpoint's number \"moving_step\" is 0, expected one from 1");
    get("moving_reached", reached_);
    get("moving_outer", outer_);
    get("moving_cg", cg_);
    lines_ = get.load_steps("moving_load_steps",
                            get.length("moving_steps_over", static_cast<std::int64_t>(curves_.size()) - 1),
                            model_.contact.size());
    const std::size_t most = most_rounds * pushed_.size() * static_cast<std::size_t>(PushedObstacle{}.most);
    forces_.resize(get.length("moving_solves", static_cast<std::int64_t>(std::max<std::size_t>(most, 1))));
    const std::vector<double> forces = get.values("moving_forces", forces_.size() * pushed_.size());
    for (std::size_t k = 0; k < forces_.size(); ++k)
      forces_[k].assign(&forces[k * pushed_.size()], &forces[k * pushed_.size()] + pushed_.size());
    searched_from_ = get.values("moving_searched_from", pushed_.size());
    for (std::size_t i = 0; i < pushed_.size(); ++i) pushed_[i].search.travel = searched_from_[i];
    contact_.resume(get.values("moving_faced_at", model_.contact.size()));
    u_ = get.nodal("moving_displacement");
  }

  /// A force-controlled contact entry in the current load step.
  struct Pushed {
    std::size_t entry = 0;
    PushedObstacle search;
  };

  /// Returns the force on an entry in the last solve.
  double force_on(std::size_t entry) const {
    std::size_t i = 0;
    while (pushed_[i].entry != entry) ++i;
    return forces_[told_ - 1][i];
  }

  /// Whether the next solve can start from the last one: its residuals are within the tolerance or at
  /// rounding level.
  bool settled() const {
    const Result& result = last_.result;
    return result.status == Status::converged || (result.status == Status::limited_by_rounding &&
                                                  result.certificate.exhausted(model_.solver.tolerance));
  }

  /// Pushes one obstacle after the other until all bear their forces at the same time (theory:
  /// force-control). Returns whether they do, with a settled last solve.
  bool push_all(const std::vector<double>& factors) {
    for (Pushed& pushed : pushed_) begin(pushed, factors[pushed.entry]);
    std::vector<Pushed*> acting;
    for (Pushed& pushed : pushed_)
      if (pushed.search.force > 0.0) acting.push_back(&pushed);
    pushes_ = !acting.empty();
    if (!pushes_) {
      solve_once();
      return settled();
    }
    bool going = true, all_have = false;
    for (int round = 0; going && round < most_rounds; ++round) {
      for (Pushed* pushed : acting) going = going && push(*pushed);
      all_have = going && std::all_of(acting.begin(), acting.end(), [&](const Pushed* pushed) {
                   return pushed->search.meets(force_on(pushed->entry));
                 });
      going = going && !all_have;
    }
    for (const Pushed* pushed : acting) last_.result.contact[pushed->entry].travel = pushed->search.travel;
    if (!going) return all_have;
    last_.result.status = Status::not_converged;
    last_.result.message = "the obstacles that are pushed act on each other, and after " +
                           std::to_string(most_rounds) + " rounds have not all the forces that are asked for";
    return false;
  }

  /// Moves the obstacle to the start of its search.
  void begin(Pushed& pushed, double factor) {
    const ContactEntry& entry = model_.contact[pushed.entry];
    PushedObstacle& search = pushed.search;
    search.force = entry.force_controlled->force * factor;
    search.tolerance = std::min(10.0 * model_.solver.tolerance, 0.1);
    search.touch = contact_.touch(pushed.entry);
    // The force does not act yet, or no longer.
    if (search.force <= 0.0) return contact_.withdraw(pushed.entry);
    search.scale = search.force / part_.laws[0].secant(0.0);
    search.scale /= part_.dim() == 3 || part_.plane == PlaneState::axisymmetric ? extent_ : part_.thickness;
    if (!std::isfinite(search.travel)) search.travel = search.touch + search.scale;
    contact_.push(pushed.entry, search.travel);
  }

  /// Solves for the travel at which an obstacle bears its force; returns whether it was found.
  bool push(Pushed& pushed) {
    const PushOutcome outcome = find_travel(pushed.search, [&](double travel) -> std::optional<double> {
      contact_.push(pushed.entry, travel);
      PlainText place;
      place << entry_name(model_.contact[pushed.entry], pushed.entry) << " pushed by " << travel;
      tell(place.str());
      solve_once();
      if (!settled()) return std::nullopt;
      return force_on(pushed.entry);
    });
    pushed.search.travel = outcome.travel;
    if (outcome.reached) return true;
    PlainText text;
    text << "the obstacle of " << entry_name(model_.contact[pushed.entry], pushed.entry) << " is pushed by "
         << pushed.search.force << ", and ";
    const bool stopped = !settled();
    text << (stopped ? "the search for its travel has stopped; at "
                     : "no travel is found at which the body bears that; at ")
         << outcome.travel << " it bears " << force_on(pushed.entry);
    if (stopped) text << ": " << last_.result.message;
    if (!stopped) last_.result.status = Status::not_converged;
    last_.result.message = text.str();
    return false;
  }

  void end_early(std::size_t step, double time) {
    const bool moves = std::any_of(model_.contact.begin(), model_.contact.end(),
                                   [](const ContactEntry& entry) { return entry.motion.has_value(); });
    if (moves && last_.result.load_factor != time) {
      PlainText place;
      place << "; obstacles with a motion are where they are at " << time;
      last_.result.message += place.str();
    }
    if (curves_.size() == 2) return;
    last_.result.message = load_step_name(step - 1, curves_.size() - 1, !model_.steps_are_factors, time) +
                           ": " + last_.result.message;
  }

  static constexpr int most_rounds = 100;

  Part& part_;
  const Model& model_;
  RunOptions run_;
  bool checkpoints_ = false;  ///< whether checkpoints are written
  bool resumes_ = false;      ///< whether the next solve begins at a checkpoint
  MovingContact contact_;
  std::vector<LoadFactors> curves_;
  double extent_;  ///< of the body
  std::vector<Pushed> pushed_;
  bool pushes_ = false;    ///< whether some obstacle is pushed in this load step
  std::vector<double> u_;  ///< at the end of the previous load step
  Start start_;
  decltype(RunOptions::load_step_over) over_;
  std::size_t step_ = 1;         ///< current load step, an index into curves_
  std::vector<LoadStep> lines_;  ///< of completed load steps
  double reached_ = 0.0;
  int outer_ = 0;  ///< iterations at its start
  std::int64_t cg_ = 0;
  std::vector<double> searched_from_;        ///< travels of pushed_ at its start
  std::vector<std::vector<double>> forces_;  ///< forces on pushed_ in each solve since then
  std::size_t told_ = 0;  ///< number of those already replayed; all of them except right after a restart
  Solution last_;         ///< its counts, times and warnings are those of all solves so far
};

}  // namespace

Model with_curves(Model model) {
  if (!any_moves(model) || !model.steps.empty()) return model;
  std::vector<double> shares = std::move(model.solver.load_steps);
  if (shares.empty()) shares = {1.0};
  model.solver.load_steps.clear();
  model.steps_are_factors = true;
  for (const double share : shares) {
    LoadStage stage{share, {}};
    for (std::size_t i = 0; i < model.boundary.size(); ++i)
      if (!model.boundary[i].is_spring()) stage.factors[entry_name(model.boundary[i], i)] = share;
    for (std::size_t i = 0; i < model.contact.size(); ++i)
      if (!model.contact[i].motion && (!model.contact[i].relinearise || model.contact[i].force_controlled))
        stage.factors[entry_name(model.contact[i], i)] = share;
    model.steps.push_back(stage);
  }
  return model;
}

Solution solve_moving(Part& part, const Model& model, RunOptions run) {
  if (part.steps.size() < 2) throw InternalError("moving obstacles without load curves");
  return Chain(part, model, run).run();
}

}  // namespace kacanov
