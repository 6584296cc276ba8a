// SPDX-License-Identifier: BSD-3-Clause
// The point of the load path that a state belongs to, with the history from the previous load step.
#include "verify/load_point.hpp"

#include <algorithm>
#include <string>

namespace kacanov::verify {
namespace {

using nlohmann::json;

/// Returns the ends of the load steps: times of the load curves, or factors.
std::vector<Real> ends_of_steps(const json& document) {
  std::vector<Real> ends;
  for (const json& step : document.value("steps", json::array()))
    ends.push_back(step.at("time").get<double>());
  if (!ends.empty()) return ends;
  const json steps = document.value("solver", json::object()).value("load_steps", json(1));
  if (steps.is_array())
    for (const json& factor : steps) ends.push_back(factor.get<double>());
  else
    for (int i = 1; i <= steps.get<int>(); ++i) ends.push_back(static_cast<double>(i) / steps.get<int>());
  return ends;
}

/// Returns the travel of force-controlled entries. `travel`: function of an entry's name.
template <class Travel>
std::vector<Real> travels(const json& document, const Travel& travel) {
  std::vector<Real> all;
  const json contact = document.value("contact", json::array());
  for (std::size_t i = 0; i < contact.size(); ++i) {
    const std::string name = contact[i].value("name", "contact[" + std::to_string(i) + "]");
    all.push_back(contact[i].contains("force_controlled") ? travel(name) : Real(0));
  }
  return all;
}

}  // namespace

std::vector<LoadPoint> load_points(const json& document, const json& result) {
  const std::vector<Real> ends = ends_of_steps(document);
  const json lines = result.value("load_steps", json::array());
  // An interrupted run has no line for its unfinished step.
  const bool open = lines.empty() || result.value("status", "") == "interrupted";
  const std::size_t steps = lines.size() + (open ? 1 : 0);
  if (steps > ends.size())
    throw Failure("result.json: load_steps: has " + std::to_string(lines.size()) +
                  " load steps, expected at most the case's " + std::to_string(ends.size()));
  std::vector<LoadPoint> points(steps);
  for (std::size_t k = 0; k < steps; ++k) {
    LoadPoint& point = points[k];
    const bool last = k + 1 == steps;
    point.step = k;
    point.end = ends[k];
    point.load = last ? Real(result.at("load_factor").get<double>()) : ends[k];
    if (k > 0) point.begin = ends[k - 1];
    point.travel = travels(document, [&](const std::string& name) -> Real {
      if (last) return result.at("contact").at(name).at("travel").get<double>();
      const json travel = lines[k].value("travel", json::object());
      if (!travel.contains(name) && !has_history(document)) return 0;  // result of an older version
      if (!travel.contains(name))
        throw Failure("result.json: expected load_steps[" + std::to_string(k) + "].travel." + name);
      return travel.at(name).get<double>();
    });
    point.travel_before = k > 0 ? points[k - 1].travel : std::vector<Real>(point.travel.size());
  }
  return points;
}

bool counts_from_step(const json& entry) {
  return entry.value("friction", json::object()).value("reference", "start") == "step";
}

bool has_history(const json& document) {
  const json contact = document.value("contact", json::array());
  return std::any_of(contact.begin(), contact.end(), [](const json& entry) {
    return counts_from_step(entry) || entry.value("relinearise", false);
  });
}

}  // namespace kacanov::verify
