// SPDX-License-Identifier: BSD-3-Clause
// Presets of the solver: names for sets of solver keys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace kacanov {

/// A name for values of solver keys.
struct Preset {
  std::string name, help;
  nlohmann::ordered_json keys;  ///< key → value
};

/// All presets; the first one is the default and sets nothing.
const std::vector<Preset>& presets();

/// The preset of a case: what it sets, and what the keys beside it change.
struct ChosenPreset {
  struct Value {
    std::string key, value;
    std::string by_user;  ///< the user's value; empty: the preset's stays
  };
  std::string name;  ///< empty: the case names none
  std::vector<Value> values;

  /// Returns "paper: outer kacanov, contact admm, …; the case sets stop paper (not kkt)"; empty without name.
  std::string text() const;
};

/// Returns the `solver` object with the keys of its preset added and those of the user kept; notes in
/// `chosen` what the preset stands for. The object must satisfy the schema.
nlohmann::json with_preset(const nlohmann::json& solver, ChosenPreset& chosen);

}  // namespace kacanov
