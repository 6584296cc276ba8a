// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a file with results or parts belongs to the case at hand, and describes the differences.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include <kacanov/checkpoint.hpp>

namespace kacanov {

/// Returns those of the named sections that the case file has.
nlohmann::json case_sections(const nlohmann::json& document, std::span<const char* const> sections);

/// Returns the sections that differ between two documents.
std::vector<std::string> differing_sections(const nlohmann::json& there, const nlohmann::json& here,
                                            std::span<const char* const> sections);

/// Returns "material differs (material[0].young: 1.0 there, 2.0 here); ...", with the first differing keys of
/// each section.
std::string describe_differences(const nlohmann::json& there, const nlohmann::json& here,
                                 std::span<const std::string> sections);

nlohmann::json fingerprint_json(const Fingerprint& print);
/// Inverse of fingerprint_json().
Fingerprint parse_fingerprint(const nlohmann::json& json);

}  // namespace kacanov
