// SPDX-License-Identifier: BSD-3-Clause
// Changes to a case from the command line: key.key[index].key=value.
#include <charconv>
#include <vector>

#include <kacanov/error.hpp>
#include "case/case_file.hpp"
#include "case/json_node.hpp"

namespace kacanov {
namespace {

using nlohmann::json;

struct Step {
  std::string key;        ///< member of an object, or empty:
  std::size_t index = 0;  ///< entry of an array
};

/// Splits "contact[0].friction.tresca" into steps; empty if it is not a path.
std::vector<Step> split(const std::string& path) {
  std::vector<Step> steps;
  std::size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      const std::size_t close = path.find(']', at);
      Step step;
      if (steps.empty() || close == std::string::npos) return {};
      const char* last = path.data() + close;
      const auto [end, error] = std::from_chars(path.data() + at + 1, last, step.index);
      if (error != std::errc() || end != last) return {};
      steps.push_back(step);
      at = close + 1;
    } else {
      if (!steps.empty()) {
        if (path[at] != '.') return {};
        ++at;
      }
      const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
      if (end == at) return {};
      steps.push_back({path.substr(at, end - at), 0});
      at = end;
    }
  }
  return steps;
}

json parse_value(const std::string& text) {
  const json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

}  // namespace

void apply_override(json& document, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  const std::vector<Step> steps = split(path);
  if (equals == std::string::npos || steps.empty()) {
    throw InputError(
        "--set: expected key=value such as solver.tolerance=1e-8 or contact[0].friction.tresca=0.02, got \"" +
        assignment + "\"");
  }
  json* place = &document;
  std::string walked;
  for (const Step& step : steps) {
    if (step.key.empty()) {
      if (!place->is_array())
        throw InputError("--set " + path + ": " + walked + " is no list in the case file");
      if (step.index >= place->size()) {
        throw InputError("--set " + path + ": " + walked + " has " + std::to_string(place->size()) +
                         " entries, counted from 0");
      }
      place = &(*place)[step.index];
      walked.append("[").append(std::to_string(step.index)).append("]");
    } else {
      if (!place->is_null() && !place->is_object()) {
        throw InputError("--set " + path + ": " + walked + " is no object in the case file");
      }
      place = &(*place)[step.key];
      walked += (walked.empty() ? "" : ".") + step.key;
    }
  }
  *place = parse_value(assignment.substr(equals + 1));
}

}  // namespace kacanov
