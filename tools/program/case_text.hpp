// SPDX-License-Identifier: BSD-3-Clause
// Cases as people like to read them, for the commands that write some.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace kacanov {

/// A case with every entry on a line of its own, below comments of a line each.
std::string case_text(const nlohmann::ordered_json& document, std::span<const std::string> comments);

/// What a comment may hold: no line ends, nothing that a terminal would obey.
std::string comment_text(const std::string& text);

/// Throws InputError where there is such a file and `force` is not set.
void refuse_existing(const std::string& path, bool force);

}  // namespace kacanov
