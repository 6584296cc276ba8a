// SPDX-License-Identifier: BSD-3-Clause
// Supported keywords of a deck: where each may stand, and which parameters it takes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/deck_lines.hpp"

namespace kacanov {

/// Place of a keyword in a deck.
enum class DeckLevel {
  model,   ///< before the first *STEP
  step,    ///< between *STEP and *END STEP
  behind,  ///< after *END STEP
  any      ///< in the model or in a step
};

struct DeckKeywordRule {
  std::string_view name;
  DeckLevel level;
  /// "GENERATE" takes no value, "NSET=" any value, "OP=MOD|NEW" one of these, "NLGEOM?" any value or none.
  std::string_view parameters;
};

/// Returns the rule of a supported keyword; null for all others.
const DeckKeywordRule* deck_rule(std::string_view keyword);

/// Returns whether the keyword leaves the solution unchanged: output, solver control, unused definitions.
bool is_harmless(std::string_view keyword);

/// Returns whether the line continues the parameters of the keyword, rather than being data: it starts with
/// NAME= or with a parameter of the keyword.
bool continues_parameters(std::string_view keyword, std::string_view line);

/// Describes each parameter that is unsupported or has an unsupported value; empty if there is none.
std::vector<std::string> parameter_faults(const DeckKeyword& keyword);

/// Describes why the keyword is not allowed there; empty if it is.
std::string level_fault(const DeckKeywordRule& rule, DeckLevel stands);

}  // namespace kacanov
