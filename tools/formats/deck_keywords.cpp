// SPDX-License-Identifier: BSD-3-Clause
// Supported keywords of a deck: where each may stand, and which parameters it takes.
#include "formats/deck_keywords.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "formats/printable.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

constexpr DeckLevel model = DeckLevel::model, step = DeckLevel::step, any = DeckLevel::any;

constexpr auto rules = std::to_array<DeckKeywordRule>({
    {"ASSEMBLY", model, "NAME="},
    {"BOUNDARY", any, "OP=MOD|NEW TYPE=DISPLACEMENT"},
    {"CLOAD", step, "OP=MOD|NEW"},
    {"DENSITY", model, ""},
    {"DLOAD", step, "OP=MOD|NEW"},
    {"DSLOAD", step, "OP=MOD|NEW"},
    {"ELASTIC", model, "TYPE="},
    {"ELEMENT", model, "TYPE= ELSET="},
    {"ELSET", any, "ELSET= GENERATE INSTANCE= INTERNAL UNSORTED"},
    {"ENDASSEMBLY", model, ""},
    {"ENDINSTANCE", model, ""},
    {"ENDPART", model, ""},
    {"ENDSTEP", step, ""},
    {"EXPANSION", model, "TYPE= ZERO="},
    {"HEADING", any, ""},
    {"INCLUDE", any, "INPUT="},
    {"INITIALCONDITIONS", model, "TYPE="},
    {"INSTANCE", model, "NAME= PART="},
    {"MATERIAL", model, "NAME="},
    {"NODE", model, "NSET= SYSTEM=R"},
    {"NSET", any, "NSET= ELSET= GENERATE INSTANCE= INTERNAL UNSORTED"},
    {"PART", model, "NAME="},
    {"PLASTIC", model, "HARDENING="},
    {"SOLIDSECTION", model, "ELSET= MATERIAL= ORIENTATION= OFFSET=0|0.|0.0"},
    {"STATIC", step, "DIRECT? SOLVER= TIMERESET TOTALTIMEATSTART= RIKS?"},
    // How a step is incremented does not change the solution at its end.
    {"STEP", any, "NAME= INC= AMPLITUDE=RAMP|STEP CONVERTSDI= EXTRAPOLATION= UNSYMM= NLGEOM? PERTURBATION"},
    {"SURFACE", any, "NAME= TYPE=ELEMENT|NODE INTERNAL"},
    {"TEMPERATURE", step, "OP=MOD|NEW"},
});
static_assert(std::is_sorted(rules.begin(), rules.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));

constexpr std::array harmless{"AMPLITUDE",      "CONTACTFILE",  "CONTACTOUTPUT",   "CONTACTPRINT",
                              "CONTROLS",       "DAMPING",      "DEPVAR",          "CONDUCTIVITY",
                              "ELFILE",         "ELPRINT",      "ELEMENTOUTPUT",   "ELEMENTFILE",
                              "ENERGYFILE",     "ENERGYOUTPUT", "ENERGYPRINT",     "FACEPRINT",
                              "FILEFORMAT",     "FILEOUTPUT",   "FILTER",          "FRICTION",
                              "HEADING",        "MONITOR",      "NODEFILE",        "NODEOUTPUT",
                              "NODEPRINT",      "ORIENTATION",  "OUTPUT",          "PHYSICALCONSTANTS",
                              "PREPRINT",       "PRINT",        "RESTART",         "SECTIONPRINT",
                              "SOLVERCONTROLS", "SPECIFICHEAT", "SURFACEBEHAVIOR", "SURFACEINTERACTION",
                              "TIMEPOINTS"};

/// A parameter of a rule: "OP=MOD|NEW" has the name OP, the kind = and the values MOD|NEW.
struct Parameter {
  std::string_view name, values;
  char kind = ' ';
};

Parameter parameter_of(std::string_view word) {
  const std::size_t end = word.find_first_of("=?");
  if (end == std::string_view::npos) return {word, {}};
  return {word.substr(0, end), word.substr(end + 1), word[end]};
}

std::optional<Parameter> find_parameter(std::string_view parameters, std::string_view name) {
  for (auto word = take_word(parameters, " "); !word.empty(); word = take_word(parameters, " "))
    if (const Parameter found = parameter_of(word); found.name == name) return found;
  return std::nullopt;
}

bool has_value(std::string_view values, std::string_view value) {
  for (auto word = take_word(values, "|"); !word.empty(); word = take_word(values, "|"))
    if (word == value) return true;
  return false;
}

/// Returns "TYPE, ELSET" for "TYPE= ELSET=".
std::string names_of(std::string_view parameters) {
  std::string list;
  for (auto word = take_word(parameters, " "); !word.empty(); word = take_word(parameters, " "))
    list += (list.empty() ? "" : ", ") + std::string(parameter_of(word).name);
  return list.empty() ? "no parameters" : list;
}

}  // namespace

const DeckKeywordRule* deck_rule(std::string_view keyword) {
  const auto found =
      std::lower_bound(rules.begin(), rules.end(), keyword,
                       [](const DeckKeywordRule& rule, std::string_view name) { return rule.name < name; });
  return found != rules.end() && found->name == keyword ? &*found : nullptr;
}

bool is_harmless(std::string_view keyword) {
  return std::find(harmless.begin(), harmless.end(), keyword) != harmless.end();
}

bool continues_parameters(std::string_view keyword, std::string_view line) {
  const std::string_view field = line.substr(0, line.find(','));
  const std::size_t equals = field.find('=');
  const std::string name = upper_case(without_blanks(field.substr(0, equals)));
  if (name.empty() || name[0] < 'A' || name[0] > 'Z') return false;
  const DeckKeywordRule* rule = deck_rule(keyword);
  return equals != std::string_view::npos ||
         (rule != nullptr && find_parameter(rule->parameters, name).has_value());
}

std::vector<std::string> parameter_faults(const DeckKeyword& keyword) {
  const DeckKeywordRule* rule = deck_rule(keyword.name);
  std::vector<std::string> faults;
  for (auto at = keyword.parameters.begin(); rule != nullptr && at != keyword.parameters.end(); ++at) {
    const std::string &name = at->first, &value = at->second;
    const std::string shown = keyword.written(*at);
    const std::optional<Parameter> known = find_parameter(rule->parameters, name);
    const bool twice =
        std::any_of(keyword.parameters.begin(), at, [&](const auto& before) { return before.first == name; });
    if (!known) {
      faults.push_back(shown + " is not known here, but " + names_of(rule->parameters));
    } else if (twice) {
      faults.push_back(shown + ": this parameter is there twice");
    } else if (known->kind == ' ' && !value.empty()) {
      faults.push_back(shown + ": " + name + " has no value");
    } else if (known->kind == '=' && value.empty()) {
      faults.push_back("expected " + name + "=<value>");
    } else if (!known->values.empty() && !has_value(known->values, upper_case(without_blanks(value)))) {
      std::string values(known->values);
      for (std::size_t bar = 0; (bar = values.find('|', bar)) != std::string::npos;)
        values.replace(bar, 1, " or ");
      faults.push_back(shown + " is not known here, but " + name + "=" + values);
    }
  }
  return faults;
}

std::string level_fault(const DeckKeywordRule& rule, DeckLevel stands) {
  if (rule.name == "STEP") return {};
  if (stands == DeckLevel::behind && rule.name == "ENDSTEP") return "it ends no *STEP";
  if (stands == DeckLevel::behind)
    return "it stands behind *END STEP, where nothing counts: expected it before the first *STEP, or in the "
           "step";
  if (rule.level == DeckLevel::step && stands == DeckLevel::model)
    return "it stands outside of a step: expected it between *STEP and *END STEP";
  if (rule.level == DeckLevel::model && stands == DeckLevel::step)
    return "it stands in a step: expected it before the first *STEP";
  return {};
}

}  // namespace kacanov
