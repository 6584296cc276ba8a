// SPDX-License-Identifier: BSD-3-Clause
// Reads height maps, numbers on a grid, from CSV, PBM, PGM and PNG files.
#include "formats/height_reader.hpp"

#include <charconv>

#include <kacanov/error.hpp>
#include "formats/mapped_file.hpp"
#include "formats/png_heights.hpp"
#include "formats/text_bytes.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

[[noreturn]] void too_few(const SourceFile& source, const NumberGrid& grid) {
  throw InputError(source.path + ": expected at least 2 × 2 heights, got " + std::to_string(grid.rows) +
                   " × " + std::to_string(grid.columns));
}

class CsvText {
 public:
  CsvText(const SourceFile& source, std::string_view bytes)
      : source_(source), bytes_(source.path, bytes), rest_(bytes_.text()) {}

  NumberGrid parse() {
    for (int line = 1; !rest_.empty(); ++line) {
      const std::string_view text = take_line(rest_);
      if (!text.starts_with('#')) take(text, line);
    }
    return std::move(grid_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const {
    throw InputError(source_.path + ":" + std::to_string(line) + ": " + message);
  }

  void take(std::string_view text, int line) {
    constexpr std::string_view between = ",; \t\r";
    std::size_t found = 0;
    for (auto word = take_word(text, between); !word.empty(); word = take_word(text, between)) {
      const auto value = to_number(word);
      if (!value) fail(line, "expected a number, got " + source_.quoted(word));
      grid_.values.push_back(*value);
      ++found;
    }
    if (found == 0) return;
    if (grid_.rows > 0 && found != grid_.columns)
      fail(line, "expected " + std::to_string(grid_.columns) + " numbers, as in the lines before, got " +
                     std::to_string(found));
    grid_.columns = found;
    ++grid_.rows;
  }

  const SourceFile& source_;
  TextBytes bytes_;
  std::string_view rest_;
  NumberGrid grid_;
};

/// PBM and PGM pictures with values as text or bytes.
class NetPicture {
 public:
  NetPicture(const SourceFile& source, std::string_view bytes) : source_(source), bytes_(bytes) {}

  NumberGrid parse() {
    const char kind = bytes_[1];
    place_ = 2;
    const bool bits = kind == '1' || kind == '4', text = kind == '1' || kind == '2';
    NumberGrid grid;
    grid.columns = number("the width");
    grid.rows = number("the height");
    const auto values = static_cast<std::int64_t>(grid.columns) * static_cast<std::int64_t>(grid.rows);
    // Check the size before looping over rows: a header may declare 2·10⁹ rows without columns.
    if (grid.rows < 2 || grid.columns < 2) too_few(source_, grid);
    if (values > NumberGrid::most_values) fail("expected at most 2^28 values, got " + std::to_string(values));
    const int most = bits ? 1 : number("the largest value");
    if (most < 1 || most > 65535)
      fail("expected a largest value from 1 to 65535, got " + std::to_string(most));
    if (!text) ++place_;  // one blank ends the header
    // A text file has at least one byte per value, so a false size in the header allocates nothing.
    if (text && static_cast<std::int64_t>(bytes_.size() - place_) < values) ends_early();
    for (std::size_t row = 0; row < grid.rows; ++row) {
      if (text)
        for (std::size_t i = 0; i < grid.columns; ++i) add(grid, bits ? digit() : number("a value"), most);
      else
        take_row(grid, bits, most);
    }
    return grid;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(source_.path + ": byte " + std::to_string(place_) + ": " + message);
  }
  [[noreturn]] void ends_early() const { fail("the file ends before the last value"); }

  void add(NumberGrid& grid, int value, int most) const {
    if (value > most)
      fail("expected a value up to " + std::to_string(most) + ", got " + std::to_string(value));
    grid.values.push_back(static_cast<double>(value) / most);
  }

  void skip_blanks() {
    while (place_ < bytes_.size()) {
      if (bytes_[place_] == '#')
        place_ = std::min(bytes_.find('\n', place_), bytes_.size());
      else if (std::string_view(" \t\r\n").find(bytes_[place_]) == std::string_view::npos)
        return;
      else
        ++place_;
    }
  }

  int number(const char* what) {
    skip_blanks();
    int value = 0;
    const char *begin = bytes_.data() + place_, *end = bytes_.data() + bytes_.size();
    const auto read = std::from_chars(begin, end, value);
    if (read.ec != std::errc() || value < 0) fail(std::string("expected ") + what + ", a whole number ≥ 0");
    place_ += static_cast<std::size_t>(read.ptr - begin);
    return value;
  }

  /// Digits of P1 may follow each other without blanks.
  int digit() {
    skip_blanks();
    if (place_ == bytes_.size()) ends_early();
    const char c = bytes_[place_];
    if (c != '0' && c != '1') fail("expected 0 or 1");
    ++place_;
    return c - '0';
  }

  void take_row(NumberGrid& grid, bool bits, int most) {
    const std::size_t width = bits ? (grid.columns + 7) / 8 : grid.columns * (most > 255 ? 2 : 1);
    if (place_ > bytes_.size() || bytes_.size() - place_ < width) ends_early();
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(bytes_[place_ + k]); };
    for (std::size_t i = 0; i < grid.columns; ++i) {
      if (bits)
        add(grid, byte(i / 8) >> (7 - i % 8) & 1, most);
      else
        add(grid, most > 255 ? byte(2 * i) * 256 + byte(2 * i + 1) : byte(i), most);
    }
    place_ += width;
  }

  const SourceFile& source_;
  std::string_view bytes_;
  std::size_t place_ = 0;
};

}  // namespace

NumberGrid parse_heights(const SourceFile& source, std::string_view bytes) {
  const bool picture = bytes.size() > 2 && bytes[0] == 'P' &&
                       std::string_view("1245").find(bytes[1]) != std::string_view::npos;
  const NumberGrid grid = picture         ? NetPicture(source, bytes).parse()
                          : is_png(bytes) ? parse_png(source, bytes)
                                          : CsvText(source, bytes).parse();
  if (grid.rows < 2 || grid.columns < 2) too_few(source, grid);
  return grid;
}

NumberGrid read_heights(const SourceFile& source) {
  const MappedFile file(source.path);
  NumberGrid grid = parse_heights(source, file.bytes());
  file.check_unchanged();
  return grid;
}

}  // namespace kacanov
