// SPDX-License-Identifier: BSD-3-Clause
// Formats case files for people, for the commands that write them.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace kacanov {

/// Returns a case with each entry on its own line, below one-line comments.
std::string case_text(const nlohmann::ordered_json& document, std::span<const std::string> comments);

/// Returns the text made safe for a comment: no line ends or control characters.
std::string comment_text(const std::string& text);

/// Throws InputError if the file exists and `force` is not set.
void refuse_existing(const std::string& path, bool force);

}  // namespace kacanov
