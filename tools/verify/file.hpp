// SPDX-License-Identifier: BSD-3-Clause
// Opens and reads input files of the verifier.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "verify/real.hpp"

namespace kacanov::verify {

/// Opens a file after its UTF-8 byte order mark, if any; throws Failure for anything but a regular file.
inline std::ifstream open_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw Failure(file.string() + ": cannot be read: no such file, or not a regular one");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Failure(file.string() + ": cannot be read");
  char mark[3] = {};
  stream.read(mark, sizeof mark);
  if (stream.gcount() == sizeof mark && std::memcmp(mark, "\xef\xbb\xbf", sizeof mark) == 0) return stream;
  stream.clear();
  stream.seekg(0);
  return stream;
}

/// Replaces carriage returns that no line feed follows, which also end lines, by line feeds.
inline std::string with_line_feeds(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') continue;
    const std::size_t next = text.find_first_not_of('\r', i);
    if (next == std::string::npos || text[next] != '\n') text[i] = '\n';
  }
  return text;
}

/// Returns the whole content.
inline std::string whole(const std::filesystem::path& file) {
  const std::ifstream stream = open_file(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace kacanov::verify
