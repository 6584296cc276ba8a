// SPDX-License-Identifier: BSD-3-Clause
// Reads lines, numbers and raw values from the bytes of a Gmsh file, and reports where an error is.
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

/// A read position in the file. `tag`, `size` and `real` read a text word or a raw value, depending on the
/// encoding of the file; the `text_` functions always read text. Every function throws InputError naming the
/// line (ASCII) or byte (binary) where something else was found.
class GmshCursor {
 public:
  GmshCursor(SourceFile source, std::string_view data);

  void set_binary() noexcept { binary_ = true; }
  bool binary() const noexcept { return binary_; }
  std::size_t remaining() const noexcept { return data_.size() - position_; }

  /// Returns the next line without its end and moves past it.
  std::string_view line();
  /// Skips blank lines; false at the end of the file.
  bool skip_blank_lines();
  std::int64_t text_integer(const char* what);
  double text_real(const char* what);
  /// Moves past the line end; only blanks may precede it.
  void text_end_of_line();
  /// Returns the rest of the line without its end and leading blanks, and moves past it.
  std::string_view text_rest();
  /// Returns the rest of the line, a name in double quotes, without the quotes. `of`: the named object, for
  /// messages.
  std::string_view text_name(const std::string& of);

  /// Reads an `int`: 32 bits in a binary file.
  std::int32_t tag(const char* what);
  /// Reads a `size_t`: 64 bits in a binary file.
  std::int64_t size(const char* what);
  double real(const char* what);
  /// Moves past the line end; does nothing in a binary file.
  void end_record() {
    if (!binary_) text_end_of_line();
  }

  /// Throws unless `count` ≥ 0 and the rest of the file has room for that many records of at least `bytes`
  /// bytes each.
  void expect_room(std::int64_t count, std::size_t bytes, const char* what) const;
  /// Moves past the line `$End<section>`, which must be next.
  void end_section(std::string_view section);
  /// Moves past the next line `$End<section>`, wherever it is.
  void skip_section(std::string_view section);

  /// Returns a word of the file as messages may quote it.
  std::string quoted(std::string_view word) const { return source_.quoted(word); }
  /// Throws InputError at the position of the last value read.
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
  std::unique_ptr<const TextBytes> text_;  // for an ASCII file
  std::string_view data_;
  std::size_t position_ = 0;
  std::size_t last_ = 0;  // start of the last value read
  bool binary_ = false;
};

}  // namespace kacanov
