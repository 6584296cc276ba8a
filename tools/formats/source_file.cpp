// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a file lies in a folder.
#include "formats/source_file.hpp"

#include <algorithm>

namespace kacanov {

SourceFile source_file(const std::string& path, const std::filesystem::path& folder) {
  std::error_code failed;
  const auto real = [&](const std::filesystem::path& name) {
    return failed ? name : std::filesystem::weakly_canonical(name, failed);
  };
  const std::filesystem::path within = real(folder.empty() ? "." : folder), file = real(path);
  const auto [left, below] = std::mismatch(within.begin(), within.end(), file.begin(), file.end());
  return {path, !failed && left == within.end() && below != file.end()};
}

}  // namespace kacanov
