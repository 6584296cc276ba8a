// SPDX-License-Identifier: BSD-3-Clause
// Every key of the case file: what it may be, its default, and a line about it.
#pragma once

#include "case/schema.hpp"

namespace kacanov {

/// A whole case file.
const Schema& case_schema();
/// The elastic constants and the law of a material, without where it is.
KeySet material_law_keys();
/// The schema of case files, which `kacanov schema` prints.
nlohmann::ordered_json case_json_schema();

/// A key that has to be there, and one that may be left out.
inline Key must(const char* name, Schema schema, const char* help) {
  return {name, std::move(schema), help, true, {}};
}
inline Key may(const char* name, Schema schema, const char* help, nlohmann::json fallback = {}) {
  return {name, std::move(schema), help, false, std::move(fallback)};
}

// Parts that have files of their own.
Schema vector_schema();
Schema axes_schema();
Schema obstacle_schema();

}  // namespace kacanov
