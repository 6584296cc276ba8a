// SPDX-License-Identifier: BSD-3-Clause
// A file to read, and how messages name it and quote it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "formats/printable.hpp"

namespace kacanov {

/// The path of a file, and whether messages may show words of it. A case or deck may name any file, such as
/// one that the person who reads the messages must not see.
struct SourceFile {
  std::string path;
  bool shown = true;

  SourceFile(std::string name, bool show = true) : path(std::move(name)), shown(show) {}
  SourceFile(const char* name) : path(name) {}

  /// A word of the file for a message.
  std::string quoted(std::string_view word) const {
    return shown ? in_quotes(word)
                 : "a text that is not shown, as the file lies outside of the case's folder";
  }
};

/// The file with its words hidden where it lies outside of the folder, links followed.
SourceFile source_file(const std::string& path, const std::filesystem::path& folder);

}  // namespace kacanov
