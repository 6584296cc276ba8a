// SPDX-License-Identifier: BSD-3-Clause
// Makes text from files safe to print: control characters, direction marks and invalid UTF-8 are shown as
// numbers.
#pragma once

#include <string>
#include <string_view>

namespace kacanov {

/// Returns the length, 1 to 4, of the UTF-8 character at the start of `text`; 0 if it is invalid.
inline std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return text.empty() ? 0 : 1;
  const std::size_t length = first >= 0xf5   ? 0
                             : first >= 0xf0 ? 4
                             : first >= 0xe0 ? 3
                             : first >= 0xc2 ? 2
                                             : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Overlong forms, surrogates and values above the last character.
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0) ||
      (first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90))
    return 0;
  return length;
}

/// Returns whether a three-byte character ends a line or changes the writing direction: separators,
/// embeddings, overrides, isolates.
inline bool changes_line(std::string_view text) {
  if (text[0] != '\xe2') return false;
  const auto last = static_cast<unsigned char>(text[2]);
  return (text[1] == '\x80' && last >= 0xa8 && last <= 0xae) ||
         (text[1] == '\x81' && last >= 0xa6 && last <= 0xa9);
}

/// Returns the text with control characters except line feeds, characters of changes_line(), and invalid
/// UTF-8 shown as \x1b. Every text from a file passes through here before it reaches a terminal, message,
/// summary, page or XML.
inline std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text[0]);
    // C1 controls, which some terminals obey, are two bytes in UTF-8: 0xc2 0x80 to 0xc2 0x9f.
    const bool control = (first < 0x20 && first != '\n') || first == 0x7f ||
                         (length == 2 && first == 0xc2 && static_cast<unsigned char>(text[1]) < 0xa0) ||
                         (length == 3 && changes_line(text));
    if (length > 0 && !control) {
      result += text.substr(0, length);
      text.remove_prefix(length);
      continue;
    }
    constexpr const char* digits = "0123456789abcdef";
    result += {'\\', 'x', digits[first >> 4], digits[first & 15]};
    text.remove_prefix(1);
  }
  return result;
}

/// Returns whether the text is one line that printable() leaves unchanged.
inline bool is_plain_line(std::string_view text) {
  return text.find('\n') == std::string_view::npos && printable(text) == text;
}

/// Returns at most `bytes` bytes of the text, without splitting a character.
inline std::string_view shortened(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  // A character has at most four bytes, all but the first of the form 10xxxxxx.
  for (std::size_t k = 0; k < 3 && bytes > 0 && (text[bytes] & 0xc0) == 0x80; ++k) --bytes;
  return text.substr(0, bytes);
}

/// Returns `text` shortened, without non-ASCII characters and in quotes, for a message.
inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) {
    const auto code = static_cast<unsigned char>(c);
    result += code >= 0x20 && code < 0x7f ? c : '?';
  }
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace kacanov
