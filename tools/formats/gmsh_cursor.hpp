// SPDX-License-Identifier: BSD-3-Clause
// Reads lines, numbers and raw values from the bytes of a Gmsh file, and says where something is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "formats/source_file.hpp"
#include "formats/text_bytes.hpp"

namespace kacanov {

/// A place in the file. `tag`, `size` and `real` read a word of text or a raw value, as the file's encoding
/// has it; the `text_` functions always read text. Every function throws InputError naming the line (ASCII)
/// or the byte (binary) at which something else was found.
class GmshCursor {
 public:
  GmshCursor(SourceFile source, std::string_view data);

  void set_binary() noexcept { binary_ = true; }
  bool binary() const noexcept { return binary_; }
  std::size_t remaining() const noexcept { return data_.size() - position_; }

  /// The next line without its end; moves behind it.
  std::string_view line();
  /// Moves over blank lines; false at the end of the file.
  bool skip_blank_lines();
  std::int64_t text_integer(const char* what);
  double text_real(const char* what);
  /// Nothing but blanks may follow on this line; moves behind it.
  void text_end_of_line();
  /// The rest of the line without its end, blanks in front removed; moves behind it.
  std::string_view text_rest();
  /// A name in double quotes, without them: the rest of the line. `of`: what it names, for messages.
  std::string_view text_name(const std::string& of);

  /// An `int`: 32 bits in a binary file.
  std::int32_t tag(const char* what);
  /// A `size_t`: 64 bits in a binary file.
  std::int64_t size(const char* what);
  double real(const char* what);
  /// Ends a line of text; nothing in a binary file.
  void end_record() {
    if (!binary_) text_end_of_line();
  }

  /// Throws unless `count` is ≥ 0 and as many records of at least `bytes` bytes each can still follow.
  void expect_room(std::int64_t count, std::size_t bytes, const char* what) const;
  /// Moves behind the line `$End<section>`, which must be next.
  void end_section(std::string_view section);
  /// Moves behind the next line `$End<section>`, wherever it is.
  void skip_section(std::string_view section);

  /// A word of the file for a message.
  std::string quoted(std::string_view word) const { return source_.quoted(word); }
  /// Throws InputError at the place of the value read last.
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_at(std::size_t position, const std::string& message) const;

 private:
  void skip_blanks() {
    while (position_ < data_.size() && (data_[position_] == ' ' || data_[position_] == '\t')) ++position_;
    last_ = position_;
  }
  template <typename T>
  T raw(const char* what) {
    last_ = position_;
    if (remaining() < sizeof(T))
      fail_at(position_, std::string("the file ends where ") + what + " was expected");
    T value;
    std::memcpy(&value, data_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }
  [[noreturn]] void fail_word(const char* expected, const char* what) const;
  void finish_word(const char* end, const char* expected, const char* what);

  SourceFile source_;
  std::unique_ptr<const TextBytes> text_;  // of an ASCII file
  std::string_view data_;
  std::size_t position_ = 0;
  std::size_t last_ = 0;  // where the value read last begins
  bool binary_ = false;
};

}  // namespace kacanov
