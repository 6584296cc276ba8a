// SPDX-License-Identifier: BSD-3-Clause
// Splits an Abaqus or CalculiX deck and its included files into keywords and data lines.
#include "formats/deck_lines.hpp"

#include <algorithm>
#include <filesystem>

#include <kacanov/error.hpp>
#include "formats/deck_keywords.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

constexpr std::size_t deepest_include = 16, most_files = 1000;

std::string_view unquoted(std::string_view text) {
  return text.size() >= 2 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2)
                                                                       : text;
}

/// Removes the text up to the next comma outside quotes, with the comma, and returns it.
std::string_view take_field(std::string_view& text) {
  bool in_quotes = false;
  std::size_t end = 0;
  for (; end < text.size() && (in_quotes || text[end] != ','); ++end) in_quotes ^= text[end] == '"';
  const std::string_view field = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trimmed(field);
}

}  // namespace

std::string without_blanks(std::string_view text) {
  std::string result(text);
  std::erase_if(result, [](char c) { return c == ' ' || c == '\t'; });
  return result;
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

const std::string* DeckKeyword::parameter(std::string_view wanted) const {
  for (const auto& [key, value] : parameters)
    if (key == wanted) return &value;
  return nullptr;
}

std::string DeckKeyword::written(const Parameter& given) const {
  if (!quotable) return "a parameter";
  return given.first + (given.second.empty() ? "" : "=" + given.second);
}

DeckLines::DeckLines(const SourceFile& source, std::string_view bytes, Open open)
    : open_(std::move(open)), files_{source}, sources_{{0, 0, bytes}} {}

void DeckLines::fail(DeckPlace place, const std::string& message) const {
  throw InputError(files_[place.file].path + ": line " + std::to_string(place.line) + ": " + message);
}

bool DeckLines::peek() {
  while (!have_ && !sources_.empty()) {
    Source& source = sources_.back();
    if (source.rest.empty()) {
      sources_.pop_back();
      continue;
    }
    ++source.line;
    before_ = source.rest;
    line_ = trimmed(take_line(source.rest));
    place_ = {source.file, source.line};
    have_ = !line_.empty() && !line_.starts_with("**");
  }
  return have_;
}

void DeckLines::put_back() {
  if (!std::exchange(have_, false)) return;
  sources_.back().rest = before_;
  --sources_.back().line;
}

void DeckLines::take_keyword_line(DeckKeyword& keyword) {
  keyword = {};
  keyword.place = place_;
  keyword.quotable = files_[place_.file].shown;
  std::string_view rest = line_.substr(1);
  const std::string_view name = take_field(rest);
  keyword.name = upper_case(without_blanks(name));
  if (name.empty() || name.size() > 60) fail(place_, "expected a keyword, got " + quoted(place_, line_));
  const bool known = deck_rule(keyword.name) != nullptr || is_harmless(keyword.name);
  keyword.shown = keyword.quotable || known ? "*" + std::string(name) : "this keyword";
  for (bool more = true; more;) {
    more = line_.back() == ',';
    while (!trimmed(rest).empty()) {
      const std::string_view field = take_field(rest);
      if (field.empty()) continue;
      const std::size_t equals = field.find('=');
      const std::string_view value =
          equals == std::string_view::npos ? std::string_view() : trimmed(field.substr(equals + 1));
      keyword.parameters.emplace_back(upper_case(without_blanks(field.substr(0, equals))), unquoted(value));
    }
    have_ = false;
    if (!more || !peek() || !continues_parameters(keyword.name, line_)) break;
    rest = line_;
  }
}

void DeckLines::include(const DeckKeyword& keyword) {
  for (const std::string& fault : parameter_faults(keyword))
    fail(keyword.place, keyword.shown + ": " + fault);
  const std::string* input = keyword.parameter("INPUT");
  if (input == nullptr) fail(keyword.place, keyword.shown + ": expected INPUT=<file>");
  put_back();
  const auto folder_of = [&](std::int32_t file) {
    return std::filesystem::path(files_[file].path).parent_path();
  };
  const std::string path = (folder_of(keyword.place.file) / *input).string();
  if (sources_.size() >= deepest_include)
    fail(keyword.place,
         "files that include each other more than " + std::to_string(deepest_include) + " deep");
  if (files_.size() >= most_files)
    fail(keyword.place, "more than " + std::to_string(most_files) + " files are included");
  std::string_view bytes;
  try {
    bytes = open_(path);
  } catch (const InputError& error) {
    fail(keyword.place, error.what());
  }
  SourceFile included = source_file(path, folder_of(0));
  included.shown = included.shown && files_[0].shown;
  files_.push_back(included);
  sources_.push_back({static_cast<std::int32_t>(files_.size()) - 1, 0, bytes});
}

std::optional<DeckKeyword> DeckLines::keyword() {
  while (peek()) {
    if (line_.front() != '*') fail(place_, "expected a keyword, got " + quoted(place_, line_));
    DeckKeyword keyword;
    take_keyword_line(keyword);
    if (keyword.name != "INCLUDE") return keyword;
    include(keyword);
  }
  return std::nullopt;
}

bool DeckLines::data(DeckRow& row) {
  while (peek()) {
    if (line_.front() == '*') {
      const std::string_view name = line_.substr(1, line_.find(',') - 1);
      if (upper_case(without_blanks(name)) != "INCLUDE") return false;
      DeckKeyword keyword;
      take_keyword_line(keyword);
      include(keyword);
      continue;
    }
    row.place = place_;
    row.fields.clear();
    row.goes_on = line_.back() == ',';
    for (std::string_view rest = line_; !rest.empty();) row.fields.push_back(unquoted(take_field(rest)));
    have_ = false;
    return true;
  }
  return false;
}

}  // namespace kacanov
