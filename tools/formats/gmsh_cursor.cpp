// SPDX-License-Identifier: BSD-3-Clause
// Reads numbers, words and raw values; messages name the line or byte.
#include "formats/gmsh_cursor.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <kacanov/error.hpp>
#include "formats/words.hpp"

namespace kacanov {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view without_carriage_return(std::string_view line) {
  while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
  return line;
}

/// Returns whether the header of the file declares binary data.
bool is_binary(std::string_view bytes) {
  constexpr std::string_view blanks = " \t\r\n";
  std::string_view rest = bytes.substr(std::min(bytes.find("$MeshFormat"), bytes.size()));
  for (int word = 0; word < 2; ++word) take_word(rest, blanks);
  return take_word(rest, blanks) == "1";
}

}  // namespace

GmshCursor::GmshCursor(SourceFile source, std::string_view data)
    : source_(std::move(source)), data_(text_start(source_.path, data)) {
  if (is_binary(data_)) return;
  text_ = std::make_unique<const TextBytes>(source_.path, data_);
  data_ = text_->text();
}

void GmshCursor::fail_at(std::size_t position, const std::string& message) const {
  position = std::min(position, data_.size());
  const std::string place =
      binary_ ? "byte " + std::to_string(position)
              : "line " + std::to_string(1 + std::count(data_.begin(),
                                                        data_.begin() + static_cast<std::ptrdiff_t>(position),
                                                        '\n'));
  throw InputError(source_.path + ": " + place + ": " + message);
}

void GmshCursor::fail(const std::string& message) const { fail_at(last_, message); }

void GmshCursor::fail_word(const char* expected, const char* what) const {
  const std::string start = std::string(what) + ": expected " + expected + ", ";
  if (last_ >= data_.size()) fail(start + "but the file ends");
  const std::string_view rest = data_.substr(last_);
  if (rest[0] == '\n' || rest[0] == '\r') fail(start + "but the line ends");
  const auto end = std::find_if(rest.begin(), rest.end(), is_space);
  fail(start + "got " + quoted(rest.substr(0, end - rest.begin())));
}

std::string_view GmshCursor::line() {
  last_ = position_;
  const std::size_t end = std::min(data_.find('\n', position_), data_.size());
  const std::string_view text = data_.substr(position_, end - position_);
  position_ = std::min(end + 1, data_.size());
  return without_carriage_return(text);
}

bool GmshCursor::skip_blank_lines() {
  while (position_ < data_.size() && is_space(data_[position_])) ++position_;
  last_ = position_;
  return position_ < data_.size();
}

void GmshCursor::finish_word(const char* end, const char* expected, const char* what) {
  const std::size_t stop = end - data_.data();
  if (stop < data_.size() && !is_space(data_[stop])) fail_word(expected, what);
  position_ = stop;
}

std::int64_t GmshCursor::text_integer(const char* what) {
  skip_blanks();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(data_.data() + position_, data_.data() + data_.size(), value);
  if (error != std::errc{}) fail_word("an integer", what);
  finish_word(end, "an integer", what);
  return value;
}

double GmshCursor::text_real(const char* what) {
  skip_blanks();
  double value = 0;
  const auto [end, error] = std::from_chars(data_.data() + position_, data_.data() + data_.size(), value);
  // An out-of-range number is either far below every length in the mesh, and becomes 0, or too large.
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(data_.data() + position_, end).c_str(), nullptr);
  else if (error != std::errc{})
    fail_word("a number", what);
  finish_word(end, "a number", what);
  if (!std::isfinite(value)) fail_word("a finite number", what);
  return value;
}

void GmshCursor::text_end_of_line() {
  skip_blanks();
  const std::string_view rest = line();
  if (!rest.empty()) fail("expected the end of the line, got " + quoted(rest));
}

std::string_view GmshCursor::text_rest() {
  skip_blanks();
  return line();
}

std::string_view GmshCursor::text_name(const std::string& of) {
  const std::string_view rest = text_rest();
  if (rest.size() < 2 || rest.front() != '"' || rest.back() != '"')
    fail("expected the name of a physical group in double quotes, got " + quoted(rest));
  const std::string_view name = rest.substr(1, rest.size() - 2);
  if (printable(name) != name) fail(of + ": its name is no UTF-8, or has control characters");
  return name;
}

std::int32_t GmshCursor::tag(const char* what) {
  if (binary_) return raw<std::int32_t>(what);
  const std::int64_t value = text_integer(what);
  if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
    fail(std::string(what) + ": " + std::to_string(value) + " is out of range");
  return static_cast<std::int32_t>(value);
}

std::int64_t GmshCursor::size(const char* what) {
  const std::int64_t value = binary_ ? raw<std::int64_t>(what) : text_integer(what);
  if (value < 0) fail(std::string(what) + ": expected a number ≥ 0, got " + std::to_string(value));
  return value;
}

double GmshCursor::real(const char* what) {
  if (!binary_) return text_real(what);
  const double value = raw<double>(what);
  if (!std::isfinite(value)) fail(std::string(what) + ": expected a finite number");
  return value;
}

void GmshCursor::expect_room(std::int64_t count, std::size_t bytes, const char* what) const {
  if (count < 0 || static_cast<std::uint64_t>(count) > remaining() / bytes)
    fail(std::to_string(count) + " " + what + " announced, but only " + std::to_string(remaining()) +
         " bytes follow: truncated or corrupt");
}

void GmshCursor::end_section(std::string_view section) {
  const std::string expected = "$End" + std::string(section);
  if (!skip_blank_lines()) fail("the file ends where " + expected + " was expected");
  const std::string_view found = line();
  if (found != expected) fail("expected " + expected + ", got " + quoted(found));
}

void GmshCursor::skip_section(std::string_view section) {
  // Search from the line end before the section's content, so that an empty section is found too.
  const std::string end = "\n$End" + std::string(section);
  const std::size_t start = last_;
  std::size_t found = position_ == 0 ? 0 : position_ - 1;
  do {
    found = data_.find(end, found);
    if (found == std::string_view::npos)
      fail_at(start,
              "$" + std::string(section) + " has no $End" + std::string(section) + ": truncated or corrupt");
    found += end.size();
  } while (found < data_.size() && !is_space(data_[found]));
  position_ = found;
  line();
}

}  // namespace kacanov
