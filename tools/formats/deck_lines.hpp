// SPDX-License-Identifier: BSD-3-Clause
// The lines of an Abaqus or CalculiX deck and of the files that it includes, taken apart.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  std::string name;                                             ///< upper case, without blanks and star
  std::string shown;                                            ///< as it is written, for messages
  std::vector<std::pair<std::string, std::string>> parameters;  ///< names upper case without blanks

  /// The value of a parameter, empty for one without; nothing where it is not there.
  const std::string* parameter(std::string_view wanted) const;
};

/// The text in upper case.
std::string upper_case(std::string_view text);

/// Reads forward through a deck, comments and empty lines left out, *INCLUDE followed. Throws InputError
/// "path: line N: ..." for what is no deck.
class DeckLines {
 public:
  /// Gives the bytes of an included file, which have to stay while the deck is read.
  using Open = std::function<std::string_view(const std::string& path)>;

  DeckLines(const std::string& path, std::string_view bytes, Open open);

  /// The next keyword; what data is left before it is passed over. Nothing at the end.
  std::optional<DeckKeyword> keyword();
  /// The next line of data of the keyword; false where there is none left.
  bool data(DeckRow& row);

  const std::vector<std::string>& files() const noexcept { return files_; }
  [[noreturn]] void fail(DeckPlace place, const std::string& message) const;

 private:
  struct Source {
    std::int32_t file;
    std::int64_t line = 0;
    std::string_view rest;
  };

  /// The next line that is no comment; false at the end.
  bool peek();
  void take_keyword_line(DeckKeyword& keyword);
  void include(const DeckKeyword& keyword);

  Open open_;
  std::vector<std::string> files_;
  std::vector<Source> sources_;  ///< the file that is read, last
  std::string_view line_;        ///< of peek(), without blanks at its ends
  DeckPlace place_;
  bool have_ = false;
};

}  // namespace kacanov
