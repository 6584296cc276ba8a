// SPDX-License-Identifier: BSD-3-Clause
// The keywords of a deck that are read: where each stands, and the parameters that it may have.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/deck_lines.hpp"

namespace kacanov {

/// Where in a deck a keyword stands, or may stand.
enum class DeckLevel {
  model,   ///< before the first *STEP
  step,    ///< between *STEP and *END STEP
  behind,  ///< behind *END STEP
  any      ///< in the model or in a step
};

struct DeckKeywordRule {
  std::string_view name;
  DeckLevel level;
  /// "GENERATE" has no value, "NSET=" any, "OP=MOD|NEW" one of these, "NLGEOM?" any or none.
  std::string_view parameters;
};

/// The rule of a keyword that is read; null for all others.
const DeckKeywordRule* deck_rule(std::string_view keyword);

/// A keyword that does not change the answer: output, control, definitions that nothing uses.
bool is_harmless(std::string_view keyword);

/// Whether a line continues the parameters of the keyword and is not data: it begins with NAME=, or with a
/// parameter of the keyword.
bool continues_parameters(std::string_view keyword, std::string_view line);

/// Describes each parameter of the keyword that is not read or has a value that is not; empty if all are
/// read.
std::vector<std::string> parameter_faults(const DeckKeyword& keyword);

/// Describes why a keyword cannot stand there; empty if it can.
std::string level_fault(const DeckKeywordRule& rule, DeckLevel stands);

}  // namespace kacanov
