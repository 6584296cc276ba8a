// SPDX-License-Identifier: BSD-3-Clause
// Whether a file that holds results of a case, or its parts, belongs to the case at hand, and what differs.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include <kacanov/checkpoint.hpp>

namespace kacanov {

/// The named sections of a case file, those that are there.
nlohmann::json case_sections(const nlohmann::json& document, std::span<const char* const> sections);

/// Those of the sections that are not equal in two documents.
std::vector<std::string> differing_sections(const nlohmann::json& there, const nlohmann::json& here,
                                            std::span<const char* const> sections);

/// What is said of sections that differ: "material differs (material[0].young: 1.0 there, 2.0 here); ...",
/// with the first keys of each.
std::string describe_differences(const nlohmann::json& there, const nlohmann::json& here,
                                 std::span<const std::string> sections);

nlohmann::json fingerprint_json(const Fingerprint& print);
/// The converse.
Fingerprint parse_fingerprint(const nlohmann::json& json);

}  // namespace kacanov
