// SPDX-License-Identifier: BSD-3-Clause
// Validates a model and its options before a mesh exists, with errors in the terms of the case file.
#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include <kacanov/error.hpp>
#include <kacanov/model.hpp>
#include "problem/input_errors.hpp"
#include "problem/load_curves.hpp"
#include "problem/model_checks.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

void check_count(const std::string& path, int value, int least = 1) {
  if (value < least) refuse(path, "a whole number ≥ " + std::to_string(least), std::to_string(value));
}

void check_selector(const std::string& path, const Selector& on) {
  if (on.kind == Selector::Kind::name && on.name.empty()) refuse(path, "a string", "\"\"");
  if (on.kind != Selector::Kind::box) return;
  check(path + ".box[0]", on.lower);
  check(path + ".box[1]", on.upper);
  for (std::size_t c = 0; c < 3; ++c)
    if (on.lower[c] > on.upper[c])
      refuse(path + ".box", "a lower corner that is below the upper one in every direction",
             "[" + shown_list(on.lower) + "," + shown_list(on.upper) + "]");
}

void check_material(const std::string& path, const MaterialEntry& entry) {
  check_selector(path + ".on", entry.on);
  if (const std::string fault = validate(entry.law); !fault.empty()) throw InputError(path + ".law." + fault);
  check(path + ".expansion", entry.expansion);
}

void check_frame(const std::string& path, const BoundaryEntry& entry) {
  if (!entry.displacement) throw InputError(path + ".frame: expected this key beside displacement alone");
  check_axes(path + ".frame", *entry.frame);
}

void check_stiffness(const std::string& path, const Vector3& stiffness) {
  for (std::size_t c = 0; c < 3; ++c) check(at(path, c), stiffness[c], not_negative);
  if (stiffness == Vector3{}) refuse(path, "a stiffness > 0 in some direction", shown_list(stiffness));
}

void check_temperature(const std::string& path, const Temperature& rise) {
  check(path, rise.value);
  check(path + ".gradient", rise.gradient);
  check(path + ".point", rise.point);
}

void check_boundary(const std::string& path, const BoundaryEntry& entry) {
  check_selector(path + ".on", entry.on);
  const int kinds = (entry.displacement ? 1 : 0) + (entry.normal ? 1 : 0) + (entry.traction ? 1 : 0) +
                    (entry.total_force ? 1 : 0) + (entry.pressure ? 1 : 0) + (entry.body_force ? 1 : 0) +
                    (entry.temperature ? 1 : 0) + (entry.spring ? 1 : 0) + (entry.normal_spring ? 1 : 0) +
                    (entry.node_spring ? 1 : 0) + (entry.node_force ? 1 : 0);
  if (kinds != 1)
    refuse(path,
           std::string(kinds == 0 ? "" : "only ") +
               "one of the keys displacement, traction, pressure, body_force, total_force, normal, spring, "
               "node_spring, node_force, temperature",
           std::to_string(kinds));
  if (entry.displacement) {
    bool any = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& value = (*entry.displacement)[c];
      if (value) check(at(path + ".displacement", c), *value);
      any = any || value;
    }
    if (!any) refuse(path + ".displacement", "at least one component that is not null", "[null,null,null]");
  }
  if (entry.normal) check(path + ".normal", *entry.normal);
  if (entry.frame) check_frame(path, entry);
  if (entry.traction) check(path + ".traction", *entry.traction);
  if (entry.total_force) check(path + ".total_force", *entry.total_force);
  if (entry.pressure) check(path + ".pressure", *entry.pressure);
  if (entry.body_force) check(path + ".body_force", *entry.body_force);
  if (entry.node_force) check(path + ".node_force", *entry.node_force);
  if (entry.temperature) check_temperature(path + ".temperature", *entry.temperature);
  if (entry.normal_spring) check(path + ".spring", *entry.normal_spring, positive);
  if (entry.spring) check_stiffness(path + ".spring", *entry.spring);
  if (entry.node_spring) check_stiffness(path + ".node_spring", *entry.node_spring);
}

void check_contact(const std::string& path, const ContactEntry& entry) {
  check_selector(path + ".on", entry.on);
  std::visit([&](const auto& obstacle) { obstacle.check(path + ".obstacle." + obstacle.key); },
             entry.obstacle);
  if (!entry.friction) return;
  check(path + ".friction.tresca", entry.friction->tresca, not_negative);
  check(path + ".friction.coulomb", entry.friction->coulomb, not_negative);
}

/// Checks the motion of a contact entry.
void check_moves(const std::string& path, const Model& model, const ContactEntry& entry) {
  if (!entry.moves()) return;
  const char* key = entry.motion ? "motion" : entry.force_controlled ? "force_controlled" : "relinearise";
  if (std::holds_alternative<ConstantGap>(entry.obstacle))
    throw InputError(path + "." + key + ": expected an obstacle that has a place, got a gap");
  if (entry.motion) {
    check(path + ".motion.centre", entry.motion->centre);
    double before = 0.0;
    for (std::size_t i = 0; i < entry.motion->path.size(); ++i) {
      const Motion::Pose& pose = entry.motion->path[i];
      const std::string place = at(path + ".motion.path", i);
      check(place + ".time", pose.time);
      if (!(pose.time > before)) refuse(place + ".time", "a time after " + shown(before), shown(pose.time));
      check(place + ".translation", pose.translation);
      check(place + ".rotation", pose.rotation);
      before = pose.time;
    }
    if (entry.motion->path.empty()) refuse(path + ".motion.path", "at least one place", "[]");
  }
  if (model.plane == PlaneState::axisymmetric && entry.motion)
    for (std::size_t i = 0; i < entry.motion->path.size(); ++i) {
      const Motion::Pose& pose = entry.motion->path[i];
      if (pose.translation[0] != 0.0 || pose.rotation != Vector3{})
        throw InputError(at(path + ".motion.path", i) +
                         ": expected a translation along y alone, the axis of an axisymmetric mesh");
    }
  if (model.plane == PlaneState::axisymmetric && entry.force_controlled &&
      entry.force_controlled->direction[0] != 0.0)
    refuse(path + ".force_controlled.direction", "a direction along y, the axis of an axisymmetric mesh",
           shown_list(entry.force_controlled->direction));
  if (!entry.force_controlled) return;
  if (entry.motion) throw InputError(path + ".force_controlled: expected no motion beside it");
  check(path + ".force_controlled.force", entry.force_controlled->force, positive);
  check_direction(path + ".force_controlled.direction", entry.force_controlled->direction);
}

/// Checks that entry names are unique, because results and load curves refer to entries by name.
void check_names(const Model& model) {
  std::map<std::string, std::string> place;
  const auto check_list = [&](const std::string& list, const auto& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::string name = entry_name(entries[i], i);
      const auto [there, added] = place.emplace(name, at(list, i));
      if (!added)
        refuse(at(list, i) + ".name", "another name than that of " + there->second, "\"" + name + "\"");
    }
  };
  check_list("boundary", model.boundary);
  check_list("contact", model.contact);
}

[[noreturn]] void unavailable(const std::string& path, const std::string& value, const std::string& instead) {
  throw InputError(path + ": " + value + " is not available; use " + instead);
}

/// Semismooth Newton (either name of it) excludes options of the ADMM loop and the paper's stop.
void check_combination(const SolverOptions& options) {
  using Options = SolverOptions;
  const bool by_step = options.stop == Options::Stop::paper;
  if (options.contact == Options::Contact::active_set && by_step)
    unavailable("solver.contact", "\"active_set\" together with the stop \"paper\"", "the stop \"kkt\"");
  const bool admm =
      options.contact == Options::Contact::admm || options.contact == Options::Contact::dual_admm;
  if (options.outer == Options::Outer::newton && (by_step || admm)) {
    const char* other = by_step ? "the stop \"paper\"" : "this value of solver.contact";
    unavailable("solver.outer", std::string("\"newton\" together with ") + other, "\"auto\" or \"kacanov\"");
  }
  const bool published = adapts(options.penalty) && options.penalty != Options::Penalty::automatic;
  if (published && options.contact == Options::Contact::dual_admm)
    unavailable("solver.contact", "\"dual_admm\" together with this value of solver.r", "\"admm\"");
}

}  // namespace

namespace {

void check_steps(const Model& model) {
  if (!model.steps.empty() && !model.solver.load_steps.empty())
    unavailable("steps", "a list of load curves together with solver.load_steps", "one of the two");
  double before = 0.0;
  for (std::size_t i = 0; i < model.steps.size(); ++i) {
    const std::string path = at("steps", i);
    const LoadStage& step = model.steps[i];
    check(path + ".time", step.time);
    if (!(step.time > before)) refuse(path + ".time", "a time after " + shown(before), shown(step.time));
    before = step.time;
    for (const auto& [name, factor] : step.factors) {
      check(path + ".factors[\"" + name + "\"]", factor);
      for (std::size_t e = 0; e < model.boundary.size(); ++e)
        if (model.boundary[e].is_spring() &&
            (name == entry_name(model.boundary[e], e) || name == at("boundary", e)))
          throw InputError(path + ".factors[\"" + name +
                           "\"]: expected a load or a displacement, got a spring");
      for (std::size_t e = 0; e < model.contact.size(); ++e) {
        const ContactEntry& entry = model.contact[e];
        if (name != entry_name(entry, e) && name != at("contact", e)) continue;
        if (entry.motion || (entry.relinearise && !entry.force_controlled))
          throw InputError(
              path + ".factors[\"" + name +
              "\"]: expected no factor of an obstacle that is faced anew or has a motion, which says "
              "where it is");
        if (entry.force_controlled) check(path + ".factors[\"" + name + "\"]", factor, not_negative);
      }
    }
  }
  load_curves(model);
}

}  // namespace

std::string entry_name(const BoundaryEntry& entry, std::size_t index) {
  return entry.name.empty() ? at("boundary", index) : entry.name;
}

std::string entry_name(const ContactEntry& entry, std::size_t index) {
  return entry.name.empty() ? at("contact", index) : entry.name;
}

bool any_moves(const Model& model) {
  return std::any_of(model.contact.begin(), model.contact.end(),
                     [](const ContactEntry& entry) { return entry.moves(); });
}

void validate(const SolverOptions& options) {
  check("solver.tolerance", options.tolerance, below_one);
  check("solver.spectrum_tolerance", options.spectrum_tolerance, below_one);
  if (options.penalty == SolverOptions::Penalty::fixed) check("solver.r", options.r, penalty_number);
  if (adapts(options.penalty) && options.r != 0.0) check("solver.first_r", options.r, positive);
  check_count("solver.max_outer", options.max_outer);
  check_count("solver.max_contact", options.max_contact);
  check_count("solver.max_cg", options.max_cg);
  check_count("solver.coarse_amg", options.coarse_amg, 0);
  const std::vector<double>& factors = options.load_steps;
  for (std::size_t i = 0; i < factors.size(); ++i) check(at("solver.load_steps", i), factors[i], load_factor);
  if (!factors.empty() && factors.back() != 1.0)
    refuse("solver.load_steps", last_factor, shown_list(factors));
  if (options.relaxation) check("solver.relaxation", *options.relaxation, over_relaxation);
  check_combination(options);
}

void validate(const Model& model) {
  Mistakes mistakes;
  mistakes.in([&] {
    check("thickness", model.thickness, positive);
    if (model.plane == PlaneState::axisymmetric && model.thickness != 1.0)
      throw InputError("thickness: expected none with an axisymmetric mesh, which goes all round");
  });
  mistakes.in([&] {
    if (model.materials.empty()) refuse("material", "at least one material", "[]");
    if (model.materials.size() >= std::numeric_limits<std::uint16_t>::max())
      throw InputError("material: expected fewer than 65535 entries");
  });
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    mistakes.in([&] { check_material(at("material", i), model.materials[i]); });
  for (std::size_t i = 0; i < model.boundary.size(); ++i)
    mistakes.in([&] { check_boundary(at("boundary", i), model.boundary[i]); });
  for (std::size_t i = 0; i < model.contact.size(); ++i) {
    mistakes.in([&] { check_contact(at("contact", i), model.contact[i]); });
    mistakes.in([&] { check_moves(at("contact", i), model, model.contact[i]); });
  }
  mistakes.in([&] { check_names(model); });
  for (std::size_t i = 0; i < model.probes.size(); ++i)
    mistakes.in([&] { check(at("probe", i), model.probes[i]); });
  mistakes.in([&] { validate(model.solver); });
  mistakes.in([&] { check_steps(model); });
  mistakes.raise();
}

}  // namespace kacanov
