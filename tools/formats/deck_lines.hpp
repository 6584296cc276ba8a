// SPDX-License-Identifier: BSD-3-Clause
// The lines of an Abaqus or CalculiX deck and of the files that it includes, taken apart.
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

/// A line of data: what stands between its commas, blanks around removed.
struct DeckRow {
  DeckPlace place;
  std::vector<std::string_view> fields;
  bool goes_on = false;  ///< ends with a comma
};

/// A line *KEYWORD, NAME=VALUE, NAME.
struct DeckKeyword {
  DeckPlace place;
  std::string name;   ///< upper case, without blanks and star
  std::string shown;  ///< as it is written, for messages
  using Parameter = std::pair<std::string, std::string>;
  std::vector<Parameter> parameters;  ///< names upper case without blanks
  bool quotable = true;               ///< messages may show words of its file

  /// The value of a parameter, empty for one without; nothing where it is not there.
  const std::string* parameter(std::string_view wanted) const;
  /// NAME=VALUE, for messages.
  std::string written(const Parameter& parameter) const;
};

/// The text in upper case.
std::string upper_case(std::string_view text);
std::string without_blanks(std::string_view text);

/// Reads forward through a deck without comments and empty lines, following *INCLUDE. A keyword continues on
/// the line behind its last comma if that line has parameters and not data. Throws InputError
/// "path: line N: ..." for other text.
class DeckLines {
 public:
  /// Gives the bytes of an included file, which have to stay while the deck is read.
  using Open = std::function<std::string_view(const std::string& path)>;

  DeckLines(const SourceFile& source, std::string_view bytes, Open open);

  /// The next keyword. Nothing at the end. Throws InputError for data that is left before it.
  std::optional<DeckKeyword> keyword();
  /// The next line of data of the keyword; false where there is none left.
  bool data(DeckRow& row);

  const std::vector<SourceFile>& files() const noexcept { return files_; }
  [[noreturn]] void fail(DeckPlace place, const std::string& message) const;
  /// A word of the file at that place for a message.
  std::string quoted(DeckPlace place, std::string_view word) const { return files_[place.file].quoted(word); }

 private:
  struct Source {
    std::int32_t file;
    std::int64_t line = 0;
    std::string_view rest;
  };

  /// The next line that is no comment; false at the end.
  bool peek();
  /// Leaves the line of peek() to the file that it is in.
  void put_back();
  void take_keyword_line(DeckKeyword& keyword);
  void include(const DeckKeyword& keyword);

  Open open_;
  std::vector<SourceFile> files_;
  std::vector<Source> sources_;  ///< the file that is read, last
  std::string_view line_;        ///< of peek(), without blanks at its ends
  std::string_view before_;      ///< what the file had left before it
  DeckPlace place_;
  bool have_ = false;
};

}  // namespace kacanov
