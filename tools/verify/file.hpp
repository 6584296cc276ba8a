// SPDX-License-Identifier: BSD-3-Clause
// Opens what the verifier reads.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "verify/real.hpp"

namespace kacanov::verify {

/// For reading from its start; throws Failure where it is no file. What waits for a writer is none.
inline std::ifstream open_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw Failure(file.string() + ": cannot be read: no such file, or not a regular one");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Failure(file.string() + ": cannot be read");
  return stream;
}

/// All that is in it.
inline std::string whole(const std::filesystem::path& file) {
  const std::ifstream stream = open_file(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace kacanov::verify
