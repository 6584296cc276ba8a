// SPDX-License-Identifier: BSD-3-Clause
// Lines, words and numbers of text files.
#pragma once

#include <optional>
#include <string_view>

namespace kacanov {

/// Takes the next line off a text: what is before its end, which goes too.
std::string_view take_line(std::string_view& text);

/// Takes the next word off a line, and what is between words before it; empty where there is none.
std::string_view take_word(std::string_view& line, std::string_view between);

/// A text without blanks, tabs and carriage returns before and behind it.
std::string_view trimmed(std::string_view text);

/// The finite number that a word is; a + may stand before it.
std::optional<double> to_number(std::string_view word);

}  // namespace kacanov
