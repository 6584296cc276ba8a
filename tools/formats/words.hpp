// SPDX-License-Identifier: BSD-3-Clause
// Splits text into lines, words and numbers.
#pragma once

#include <optional>
#include <string_view>

namespace kacanov {

/// Removes the first line from a text, with its line end, and returns it without the end.
std::string_view take_line(std::string_view& text);

/// Removes the next word from a line, with the separators before it, and returns it; empty if there is none.
std::string_view take_word(std::string_view& line, std::string_view between);

/// Returns the text without leading and trailing blanks, tabs and carriage returns.
std::string_view trimmed(std::string_view text);

/// Returns the finite number that the word spells; a leading + is allowed.
std::optional<double> to_number(std::string_view word);

}  // namespace kacanov
