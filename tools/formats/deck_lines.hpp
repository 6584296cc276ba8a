// SPDX-License-Identifier: BSD-3-Clause
// Splits an Abaqus or CalculiX deck and its included files into keywords and data lines.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/source_file.hpp"

namespace kacanov {

struct DeckPlace {
  std::int32_t file = 0;  ///< index into DeckLines::files()
  std::int64_t line = 0;  ///< from 1
};

/// A data line: its comma-separated fields, without surrounding blanks.
struct DeckRow {
  DeckPlace place;
  std::vector<std::string_view> fields;
  bool goes_on = false;  ///< ends with a comma: the next line continues it
};

/// A keyword line: *KEYWORD, NAME=VALUE, NAME.
struct DeckKeyword {
  DeckPlace place;
  std::string name;   ///< upper case, without blanks and the asterisk
  std::string shown;  ///< as written, for messages
  using Parameter = std::pair<std::string, std::string>;
  std::vector<Parameter> parameters;  ///< names in upper case without blanks
  bool quotable = true;               ///< messages may quote words of its file

  /// Returns the value of a parameter, empty if it has none; null if the parameter is absent.
  const std::string* parameter(std::string_view wanted) const;
  /// Returns NAME=VALUE for messages.
  std::string written(const Parameter& parameter) const;
};

/// Returns the text in upper case.
std::string upper_case(std::string_view text);
std::string without_blanks(std::string_view text);

/// Reads a deck forward, skips comments and empty lines, and follows *INCLUDE. If a keyword line ends with a
/// comma and parameters follow on the next line, they belong to the keyword. Throws InputError "path: line N:
/// ..." on other text.
class DeckLines {
 public:
  /// Returns the bytes of an included file, which must stay valid while the deck is read.
  using Open = std::function<std::string_view(const std::string& path)>;

  DeckLines(const SourceFile& source, std::string_view bytes, Open open);

  /// Returns the next keyword, or nothing at the end. Throws InputError if data lines are left before it.
  std::optional<DeckKeyword> keyword();
  /// Reads the next data line of the keyword; false if there is none left.
  bool data(DeckRow& row);

  const std::vector<SourceFile>& files() const noexcept { return files_; }
  [[noreturn]] void fail(DeckPlace place, const std::string& message) const;
  /// Returns a word of the file at that place as messages may quote it.
  std::string quoted(DeckPlace place, std::string_view word) const { return files_[place.file].quoted(word); }

 private:
  struct Source {
    std::int32_t file;
    std::int64_t line = 0;
    std::string_view rest;
  };

  /// Moves to the next line that is not a comment; false at the end.
  bool peek();
  /// Returns the line of peek() to its file.
  void put_back();
  void take_keyword_line(DeckKeyword& keyword);
  void include(const DeckKeyword& keyword);

  Open open_;
  std::vector<SourceFile> files_;
  std::vector<Source> sources_;  ///< the last one is being read
  std::string_view line_;        ///< line of peek(), trimmed
  std::string_view before_;      ///< rest of the file before that line was taken
  DeckPlace place_;
  bool have_ = false;
};

}  // namespace kacanov
