// SPDX-License-Identifier: BSD-3-Clause
// What a value of the case file may be, described once: the check before a case is read and the JSON schema
// both come from it.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <kacanov/rules.hpp>
#include "case/json_node.hpp"

namespace kacanov {

struct AnyForm;

/// What a value may be: one of the structs below, which copies share.
class Schema {
 public:
  template <class Form>
  Schema(Form form);
  const AnyForm& form() const noexcept { return *form_; }
  /// The same with a name: in the schema it is a definition of its own, referred to where it is used.
  Schema named(std::string name) const;
  const std::string& name() const noexcept { return name_; }

 private:
  std::shared_ptr<const AnyForm> form_;
  std::string name_;
};

/// A string that is not empty, on one line and without control characters; line ends and tabs where `lines`.
struct Text {
  bool lines = false;
};
/// true or false.
struct Flag {};
struct Null {};

struct Number {
  NumberRule rule = kacanov::any_number;
};

/// A whole number.
struct Whole {
  int least = 0, most = std::numeric_limits<int>::max();
  std::string words_above = {};  ///< what was expected instead of more than `most`
};

/// A string out of a few.
struct Word {
  std::vector<std::string> words;
  std::string expected = {};  ///< in messages; empty: the words
};

/// Entries that are all alike.
struct ListOf {
  static constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();
  Schema entry;
  std::string expected;  ///< in messages, as in "a list of 2 or 3 numbers"
  std::size_t least = 0, most = any_number;
  std::string words_below = {}, words_above = {};  ///< of lists of another length; empty: `expected`
};

/// Each entry as its place has it.
struct Tuple {
  std::vector<Schema> entries;
  std::string expected;
};

struct Key {
  std::string name;
  Schema value;
  std::string help;  ///< a line for people who write a case
  bool required = false;
  nlohmann::json fallback = {};  ///< what leaving it out stands for; null: nothing that could be written
};

/// Of these keys one is there, or at most one.
struct OneOf {
  std::vector<std::string> keys;
  bool required = true;
};

/// `key` is there with `main` alone; `both`: and `main` with `key` alone.
struct Beside {
  std::string key, main;
  bool both = false;
};

/// An object of these keys and no others.
struct KeySet {
  std::vector<Key> keys;
  std::vector<OneOf> one_of = {};
  std::vector<Beside> beside = {};
};

/// An object with any keys.
struct MapOf {
  Schema entry;
  std::string expected;
};

/// An object whose other keys depend on the word that is at one of them.
struct Kinds {
  std::string tag;
  std::vector<std::pair<std::string, KeySet>> kinds;  ///< the tag is among the keys of each
};

/// They differ in their type of JSON, by which it is told which one is meant.
struct Either {
  std::vector<Schema> choices;
  std::string expected;
};

struct AnyForm {
  std::variant<Text, Flag, Null, Number, Whole, Word, ListOf, Tuple, KeySet, MapOf, Kinds, Either> form;
};

template <class Form>
Schema::Schema(Form form) : form_(std::make_shared<const AnyForm>(AnyForm{std::move(form)})) {}

/// Throws InputError about all that is not as described: an unknown key, with the closest that is
/// known, a missing one, a wrong type, a number out of range; named by its path, with what was expected.
void check(const Node& node, const Schema& schema);

/// The same as a JSON schema, draft 2020-12, its definitions included; `heading` comes first in it.
nlohmann::ordered_json json_schema(const Schema& schema, nlohmann::ordered_json heading);

}  // namespace kacanov
