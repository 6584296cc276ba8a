// SPDX-License-Identifier: BSD-3-Clause
// Schema of the case file: type, default and one line of help for every key.
#pragma once

#include "case/schema.hpp"

namespace kacanov {

/// Schema of a whole case file.
const Schema& case_schema();
/// Keys of a material's elastic constants and law, without `on`.
KeySet material_law_keys();
/// JSON schema of case files, as `kacanov schema` prints it.
nlohmann::ordered_json case_json_schema();

/// A required key (must) and an optional key (may).
inline Key must(const char* name, Schema schema, const char* help) {
  return {name, std::move(schema), help, true, {}};
}
inline Key may(const char* name, Schema schema, const char* help, nlohmann::json fallback = {}) {
  return {name, std::move(schema), help, false, std::move(fallback)};
}

// Sub-schemas that are defined in files of their own.
Schema vector_schema();
Schema axes_schema();
Schema obstacle_schema();

}  // namespace kacanov
