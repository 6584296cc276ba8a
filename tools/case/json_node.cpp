// SPDX-License-Identifier: BSD-3-Clause
// A JSON value with its path in the document, so that error messages can name the key.
#include "case/json_node.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <kacanov/error.hpp>
#include "formats/text_bytes.hpp"
#include "problem/input_errors.hpp"

namespace kacanov {
namespace {

using nlohmann::json;

/// A case has about five levels; recursion through thousands of levels would overflow the stack.
constexpr std::size_t deepest = 64;

std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  constexpr std::size_t longest = 60;
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

/// Returns "line:column" of a byte offset.
std::string place(const std::string& text, std::size_t byte) {
  const std::size_t end = std::min(byte, text.size());
  std::size_t line = 1, start = 0;
  for (std::size_t i = 0; i < end; ++i) {
    if (text[i] != '\n') continue;
    // The parser counts the offending byte: a newline belongs to the line that it ends.
    if (i + 1 == end) break;
    ++line;
    start = i + 1;
  }
  return std::to_string(line) + ":" + std::to_string(std::max<std::size_t>(1, end - start));
}

/// Returns nlohmann's message without its own line and column.
std::string reason(const std::string& what) {
  for (const char* mark : {"parsing value - ", "parsing object key - ", "parsing object - ",
                           "parsing array - ", "syntax error while parsing ", "parse error"}) {
    const std::size_t at = what.find(mark);
    if (at != std::string::npos) return what.substr(at + std::string(mark).size());
  }
  return what;
}

/// Scans the text once without building a document: finds repeated keys, numbers out of range and syntax
/// errors.
class Scanner : public nlohmann::json_sax<json> {
 public:
  Scanner(const std::string& text, const std::string& label) : text_(text), label_(label) {}

  bool null() override { return next(); }
  bool boolean(bool) override { return next(); }
  bool number_integer(number_integer_t) override { return next(); }
  bool number_unsigned(number_unsigned_t) override { return next(); }
  bool number_float(number_float_t, const string_t&) override { return next(); }
  bool string(string_t&) override { return next(); }
  bool binary(binary_t&) override { return next(); }
  bool start_object(std::size_t) override { return push(false); }
  bool start_array(std::size_t) override { return push(true); }
  bool end_object() override { return pop(); }
  bool end_array() override { return pop(); }
  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.key = name;
    if (!level.keys.insert(name).second) throw InputError(path() + ": this key is there twice");
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    if (dynamic_cast<const nlohmann::detail::out_of_range*>(&error) != nullptr) {
      throw InputError(path() + ": the number " + token + " is too large");
    }
    throw InputError(label_ + ":" + place(text_, position) + ": not valid JSON: " + reason(error.what()));
  }

 private:
  struct Level {
    bool array = false;
    std::size_t index = 0;
    std::string key;
    std::set<std::string> keys;
  };

  bool next() {
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }
  bool push(bool array) {
    if (levels_.size() == deepest)
      throw InputError(path() + ": more than " + std::to_string(deepest) + " levels of brackets");
    levels_.push_back({array, 0, {}, {}});
    return true;
  }
  bool pop() {
    levels_.pop_back();
    return next();
  }
  std::string path() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.array) {
        text += "[" + std::to_string(level.index) + "]";
      } else {
        text += (text.empty() ? "" : ".") + level.key;
      }
    }
    return text;
  }

  const std::string& text_;
  const std::string& label_;
  std::vector<Level> levels_;
};

}  // namespace

json parse_json(const std::string& bytes, const std::string& label) {
  const TextBytes plain(label, bytes);
  const std::string text(plain.text());
  if (std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) != 0; })) {
    throw InputError(label + ": the file is empty, expected a JSON object");
  }
  Scanner scanner(text, label);
  json::sax_parse(text, &scanner, json::input_format_t::json, true, true);
  json value = json::parse(text, nullptr, true, true);
  if (!value.is_object()) throw InputError(label + ": expected a JSON object, got " + shown(value));
  return value;
}

void Node::expected(const std::string& what) const {
  throw InputError(path_ + ": expected " + what + ", got " + shown(*value_));
}

double Node::number(const NumberRule& rule) const {
  if (!value_->is_number()) expected(rule.words);
  const double number = value_->get<double>();
  if (!(std::abs(number) <= largest_number))
    expected(std::string(rule.words) + " of a magnitude below 1e100");
  if (!rule.holds(number)) expected(rule.words);
  return number;
}

int Node::integer(int least) const {
  const std::string wanted = "a whole number ≥ " + std::to_string(least);
  if (!value_->is_number()) expected(wanted);
  const double value = value_->get<double>();
  if (!(value == std::floor(value) && value >= least)) expected(wanted);
  constexpr int most = std::numeric_limits<int>::max();
  if (value > most) expected("a whole number ≤ " + std::to_string(most));
  return static_cast<int>(value);
}

bool Node::boolean() const {
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

std::string Node::text() const {
  if (!value_->is_string() || value_->get_ref<const std::string&>().empty()) expected("a string");
  return value_->get<std::string>();
}

std::vector<Node> Node::list(const std::string& what) const {
  if (!value_->is_array()) expected(what);
  std::vector<Node> entries;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    entries.emplace_back((*value_)[i], path_ + "[" + std::to_string(i) + "]");
  }
  return entries;
}

std::size_t Node::choice(const std::vector<std::string_view>& words) const {
  std::string list;
  std::vector<std::string> candidates;
  for (const std::string_view word : words) {
    if (value_->is_string() && value_->get_ref<const std::string&>() == word) return candidates.size();
    list += (list.empty()                            ? ""
             : candidates.size() + 1 == words.size() ? " or "
                                                     : ", ") +
            ("\"" + std::string(word) + "\"");
    candidates.emplace_back(word);
  }
  std::string message = list;
  if (value_->is_string()) {
    const std::string guess = closest_word(value_->get_ref<const std::string&>(), candidates);
    if (!guess.empty()) {
      throw InputError(path_ + ": expected " + list + ", got " + shown(*value_) + " (did you mean \"" +
                       guess + "\"?)");
    }
  }
  expected(list);
}

std::string Object::path_of(const std::string& key) const {
  return node_.path().empty() ? key : node_.path() + "." + key;
}

Node Object::required(const std::string& key) const {
  const std::optional<Node> node = optional(key);
  if (!node) throw InputError(path_of(key) + ": this key is missing");
  return *node;
}

std::optional<Node> Object::optional(const std::string& key) const {
  const auto found = node_.value().find(key);
  if (found == node_.value().end()) return std::nullopt;
  return Node(*found, path_of(key));
}

}  // namespace kacanov
