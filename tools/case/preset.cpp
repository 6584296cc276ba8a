// SPDX-License-Identifier: BSD-3-Clause
// Presets of the solver: names for sets of solver keys.
#include "case/preset.hpp"

#include <algorithm>

namespace kacanov {
namespace {

/// The route of the paper with one of its two contact algorithms. It solves one mesh, from rest.
nlohmann::ordered_json paper_route(const char* contact) {
  return {{"outer", "kacanov"},
          {"contact", contact},
          {"r", "paper"},
          {"relaxation", 1},
          {"preconditioner", "elasticity"},
          {"stop", "kkt"},
          {"nested", false}};
}

std::string shown_value(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list{
      {"default", "the defaults of all keys", nlohmann::ordered_json::object()},
      {"paper", "Kačanov steps, Algorithm 1, r* by PARPACK, CG with BoomerAMG", paper_route("admm")},
      {"dual", "the same with Algorithm 2", paper_route("dual_admm")}};
  return list;
}

nlohmann::json with_preset(const nlohmann::json& solver, ChosenPreset& chosen) {
  nlohmann::json all = solver;
  const auto name = solver.find("preset");
  if (name == solver.end()) return all;
  chosen.name = name->get<std::string>();
  const auto preset = std::find_if(presets().begin(), presets().end(),
                                   [&](const Preset& one) { return one.name == chosen.name; });
  for (const auto& [key, value] : preset->keys.items()) {
    const auto given = solver.find(key);
    chosen.values.push_back({key, shown_value(value), given == solver.end() ? "" : shown_value(*given)});
    if (given == solver.end()) all[key] = value;
  }
  if (!preset->keys.empty()) return all;
  // Everything that stands beside the preset that sets nothing changes it.
  for (const auto& [key, value] : solver.items())
    if (key != "preset") chosen.values.push_back({key, "", shown_value(value)});
  return all;
}

std::string ChosenPreset::text() const {
  if (name.empty()) return {};
  std::string kept, changed;
  for (const Value& v : values) {
    if (v.by_user.empty())
      append(kept, v.key + " " + v.value);
    else
      append(changed, v.key + " " + v.by_user + (v.value.empty() ? "" : " (not " + v.value + ")"));
  }
  if (kept.empty() && name == "default") kept = "the default of every key";
  if (kept.empty()) kept = "nothing";
  return name + ": " + kept + (changed.empty() ? "" : "; the case sets " + changed);
}

}  // namespace kacanov
