// SPDX-License-Identifier: BSD-3-Clause
// An input file: its path, and how messages quote it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "formats/printable.hpp"

namespace kacanov {

/// Path of a file, and whether messages may quote its content. A case or deck may name any file, even one
/// that the reader of the messages must not see.
struct SourceFile {
  std::string path;
  bool shown = true;

  SourceFile(std::string name, bool show = true) : path(std::move(name)), shown(show) {}
  SourceFile(const char* name) : path(name) {}

  /// Returns a word of the file as messages may quote it.
  std::string quoted(std::string_view word) const {
    return shown ? in_quotes(word)
                 : "a text that is not shown, as the file lies outside of the case's folder";
  }
};

/// Returns the file; its content is not quoted if it lies outside `folder` once links are resolved.
SourceFile source_file(const std::string& path, const std::filesystem::path& folder);

}  // namespace kacanov
