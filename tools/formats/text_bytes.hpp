// SPDX-License-Identifier: BSD-3-Clause
// Normalises the text of a file: no byte order mark, line feeds at line ends.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <kacanov/error.hpp>

namespace kacanov {

/// Returns the encoding if the text starts like UTF-16 or UTF-32, with or without a byte order mark; else
/// empty.
inline std::string_view wide_encoding(std::string_view bytes) {
  using namespace std::string_view_literals;
  // The mark of UTF-32 starts with that of UTF-16, so test it first.
  if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) return "UTF-32";
  if (bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv)) return "UTF-16";
  if (bytes.size() < 4) return {};
  std::string zeros;
  for (const char c : bytes.substr(0, 4)) zeros += c == '\0' ? '0' : 'x';
  if (zeros == "x0x0" || zeros == "0x0x") return "UTF-16";
  return zeros == "x000" || zeros == "000x" ? "UTF-32" : std::string_view();
}

/// Returns the bytes after a UTF-8 byte order mark. Throws InputError for UTF-16 or UTF-32. All readers of
/// formats that begin with text use it.
inline std::string_view text_start(const std::string& path, std::string_view bytes) {
  if (const std::string_view encoding = wide_encoding(bytes); !encoding.empty())
    throw InputError(path + ": the text is in " + std::string(encoding) +
                     ", expected UTF-8: save it as UTF-8");
  return bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
}

/// Content of a text file; a carriage return without a line feed also ends a line. The bytes must stay valid;
/// they are copied only if there are such carriage returns.
class TextBytes {
 public:
  TextBytes(const std::string& path, std::string_view bytes) : text_(text_start(path, bytes)) {
    constexpr std::size_t none = std::string_view::npos;
    for (std::size_t begin = text_.find('\r'), end = begin; begin != none; begin = text_.find('\r', end)) {
      end = std::min(text_.find_first_not_of('\r', begin), text_.size());
      if (end < text_.size() && text_[end] == '\n') continue;
      if (own_.empty()) own_ = text_;
      std::fill(own_.begin() + static_cast<std::ptrdiff_t>(begin),
                own_.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    }
    if (!own_.empty()) text_ = own_;
  }
  TextBytes(const TextBytes&) = delete;
  TextBytes& operator=(const TextBytes&) = delete;

  std::string_view text() const noexcept { return text_; }

 private:
  std::string own_;
  std::string_view text_;
};

}  // namespace kacanov
