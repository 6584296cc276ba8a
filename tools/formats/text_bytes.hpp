// SPDX-License-Identifier: BSD-3-Clause
// The text in the bytes of a file: no byte order mark, line feeds at the ends of lines.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <kacanov/error.hpp>

namespace kacanov {

/// The encoding that text in UTF-16 or UTF-32 begins like, with a byte order mark or without; empty for
/// others.
inline std::string_view wide_encoding(std::string_view bytes) {
  using namespace std::string_view_literals;
  // The mark of UTF-32 begins with that of UTF-16.
  if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) return "UTF-32";
  if (bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv)) return "UTF-16";
  if (bytes.size() < 4) return {};
  std::string zeros;
  for (const char c : bytes.substr(0, 4)) zeros += c == '\0' ? '0' : 'x';
  if (zeros == "x0x0" || zeros == "0x0x") return "UTF-16";
  return zeros == "x000" || zeros == "000x" ? "UTF-32" : std::string_view();
}

/// The bytes behind a byte order mark of UTF-8. Throws InputError for text in UTF-16 or UTF-32. Every reader
/// of a format that begins with text takes its bytes through here.
inline std::string_view text_start(const std::string& path, std::string_view bytes) {
  if (const std::string_view encoding = wide_encoding(bytes); !encoding.empty())
    throw InputError(path + ": the text is in " + std::string(encoding) +
                     ", expected UTF-8: save it as UTF-8");
  return bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
}

/// The text of a file, all of which is text: a carriage return without a line feed ends a line, too. The
/// bytes have to stay; they are copied only where such carriage returns are.
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
