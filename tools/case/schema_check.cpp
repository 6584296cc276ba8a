// SPDX-License-Identifier: BSD-3-Clause
// Checks a value against its schema and collects error messages.
#include <algorithm>
#include <string_view>

#include <kacanov/error.hpp>
#include "case/schema.hpp"
#include "formats/printable.hpp"
#include "problem/input_errors.hpp"

namespace kacanov {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

std::vector<std::string> names(const KeySet& set) {
  std::vector<std::string> list;
  for (const Key& key : set.keys) list.push_back(key.name);
  return list;
}

/// Returns whether the JSON type of a value matches a form.
struct HasType {
  const nlohmann::json& value;
  bool operator()(const Text&) const { return value.is_string(); }
  bool operator()(const Word&) const { return value.is_string(); }
  bool operator()(const Flag&) const { return value.is_boolean(); }
  bool operator()(const Null&) const { return value.is_null(); }
  bool operator()(const Number&) const { return value.is_number(); }
  bool operator()(const Whole&) const { return value.is_number(); }
  bool operator()(const ListOf&) const { return value.is_array(); }
  bool operator()(const Tuple&) const { return value.is_array(); }
  bool operator()(const KeySet&) const { return value.is_object(); }
  bool operator()(const MapOf&) const { return value.is_object(); }
  bool operator()(const Kinds&) const { return value.is_object(); }
  bool operator()(const Either&) const { return false; }
};

/// Throws for the value itself, and collects errors of its parts in `mistakes`.
struct Check {
  const Node& node;
  Mistakes& mistakes;

  void operator()(const Text& form) const {
    std::string text = node.text();
    if (form.lines)
      std::replace_if(
          text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    if (!is_plain_line(text))
      node.expected(std::string("a string in UTF-8") + (form.lines ? "" : " on one line") +
                    " without control characters");
  }
  void operator()(const Flag&) const { node.boolean(); }
  void operator()(const Null&) const {
    if (!node.value().is_null()) node.expected("null");
  }
  void operator()(const Number& form) const { node.number(form.rule); }
  void operator()(const Whole& form) const {
    if (node.integer(form.least) > form.most) node.expected(form.words_above);
  }
  void operator()(const Word& form) const {
    if (form.expected.empty()) {
      node.choice({form.words.begin(), form.words.end()});
    } else if (std::find(form.words.begin(), form.words.end(), node.value()) == form.words.end()) {
      node.expected(form.expected);
    }
  }
  void operator()(const ListOf& form) const {
    const std::vector<Node> entries = node.list(form.expected);
    const auto refuse = [&](const std::string& words) {
      node.expected(words.empty() ? form.expected : words);
    };
    if (entries.size() < form.least) refuse(form.words_below);
    if (entries.size() > form.most) refuse(form.words_above);
    std::vector<std::string> wrong;
    for (const Node& entry : entries) try {
        std::visit(Check{entry, mistakes}, form.entry.form().form);
      } catch (const InputError& error) {
        wrong.emplace_back(error.what());
      }
    // If every entry is wrong, as when one point is given for a list of points, report one error only.
    if (wrong.size() == entries.size()) wrong.resize(std::min<std::size_t>(wrong.size(), 1));
    for (const std::string& mistake : wrong) mistakes.note(mistake);
  }
  void operator()(const Tuple& form) const {
    const std::vector<Node> entries = node.list(form.expected);
    if (entries.size() != form.entries.size()) node.expected(form.expected);
    for (std::size_t i = 0; i < entries.size(); ++i) within(entries[i], form.entries[i]);
  }
  void operator()(const MapOf& form) const {
    if (!node.value().is_object()) node.expected(form.expected);
    for (const auto& [name, value] : node.value().items())
      within(Node(value, node.path() + "[\"" + name + "\"]"), form.entry);
  }
  void operator()(const Kinds& form) const {
    if (!node.value().is_object()) node.expected("an object with the keys " + joined(all_keys(form)));
    // Check the tag first: a wrong tag must not show up as keys that do not belong to it.
    std::vector<std::string_view> kinds;
    for (const auto& kind : form.kinds) kinds.push_back(kind.first);
    (*this)(form.kinds[Object(node).required(form.tag).choice(kinds)].second);
  }
  void operator()(const Either& form) const {
    for (const Schema& schema : form.choices)
      if (std::visit(HasType{node.value()}, schema.form().form)) return within(node, schema);
    node.expected(form.expected);
  }
  void operator()(const KeySet& set) const {
    if (!node.value().is_object()) node.expected("an object with the keys " + joined(names(set)));
    const std::vector<std::string> meant = note_unknown(set);
    const auto is_meant = [&](const std::string& key) {
      return std::find(meant.begin(), meant.end(), key) != meant.end();
    };
    const Object object(node);
    for (const Key& key : set.keys)
      if (key.required && !is_meant(key.name)) mistakes.in([&] { object.required(key.name); });
    for (const OneOf& group : set.one_of)
      if (std::none_of(group.keys.begin(), group.keys.end(), is_meant))
        mistakes.in([&] { check_one_of(group); });
    for (const Beside& pair : set.beside) {
      if (is_meant(pair.key) || is_meant(pair.main)) continue;
      const auto key = object.optional(pair.key);
      const bool main = node.value().contains(pair.main);
      mistakes.in([&] {
        if (key && !main) key->expected("this key beside " + pair.main + " alone");
        if (pair.both && main) object.required(pair.key);
      });
    }
    for (const Key& key : set.keys)
      if (const auto value = object.optional(key.name)) within(*value, key.value);
  }

 private:
  void within(const Node& part, const Schema& schema) const {
    mistakes.in([&] { std::visit(Check{part, mistakes}, schema.form().form); });
  }
  static std::vector<std::string> all_keys(const Kinds& form) {
    std::vector<std::string> list;
    for (const auto& kind : form.kinds)
      for (const Key& key : kind.second.keys)
        if (std::find(list.begin(), list.end(), key.name) == list.end()) list.push_back(key.name);
    return list;
  }
  /// Reports unknown keys. Returns the keys that were probably meant, which are not reported as missing too.
  std::vector<std::string> note_unknown(const KeySet& set) const {
    const std::vector<std::string> known = names(set);
    std::vector<std::string> meant;
    for (const auto& [key, value] : node.value().items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::string guess = closest_word(key, known);
      mistakes.note(Object(node).path_of(key) + ": unknown key" +
                    (guess.empty() ? "" : " (did you mean \"" + guess + "\"?)") +
                    "; known here: " + joined(known));
      if (!guess.empty()) meant.push_back(guess);
    }
    return meant;
  }
  void check_one_of(const OneOf& group) const {
    const std::string place = node.path().empty() ? "the case" : node.path();
    std::string present;
    for (const std::string& key : group.keys) {
      if (!node.value().contains(key)) continue;
      if (!present.empty())
        throw InputError(place + ": expected only one of the keys " + joined(group.keys) + ", got " +
                         present + " and " + key);
      present = key;
    }
    if (present.empty() && group.required)
      throw InputError(place + ": expected one of the keys " + joined(group.keys));
  }
};

}  // namespace

void check(const Node& node, const Schema& schema) {
  Mistakes mistakes;
  mistakes.in([&] { std::visit(Check{node, mistakes}, schema.form().form); });
  mistakes.raise();
}

}  // namespace kacanov
