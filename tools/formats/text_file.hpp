// SPDX-License-Identifier: BSD-3-Clause
// A text file that is written in pieces and appears under its name once it is complete.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "formats/atomic_file.hpp"

namespace kacanov {

class TextFile {
 public:
  explicit TextFile(const std::string& path) : file_(path) {}

  void text(std::string_view piece) {
    text_ += piece;
    if (text_.size() > most) flush();
  }
  void number(std::int64_t value) { text(std::to_string(value)); }
  /// Writes as few digits as are needed to read back the same number.
  void number(double value) {
    char digits[32];
    text({digits,
          static_cast<std::size_t>(std::to_chars(digits, digits + sizeof digits, value).ptr - digits)});
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t most = std::size_t{1} << 20;
  void flush() {
    file_.write(text_);
    text_.clear();
  }
  AtomicFile file_;
  std::string text_;
};

}  // namespace kacanov
