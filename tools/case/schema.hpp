// SPDX-License-Identifier: BSD-3-Clause
// Schema of the case file: one description from which both input checks and the JSON schema are derived.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <kacanov/model.hpp>
#include "case/json_node.hpp"

namespace kacanov {

struct AnyForm;

/// Type of a value: one of the structs below. Copies share it.
class Schema {
 public:
  template <class Form>
  Schema(Form form);
  const AnyForm& form() const noexcept { return *form_; }
  /// Returns a named copy: the JSON schema puts it under $defs and refers to it.
  Schema named(std::string name) const;
  const std::string& name() const noexcept { return name_; }

 private:
  std::shared_ptr<const AnyForm> form_;
  std::string name_;
};

/// A non-empty string without control characters, on one line; `lines`: line feeds and tabs are allowed.
struct Text {
  bool lines = false;
};
/// A boolean.
struct Flag {};
struct Null {};

struct Number {
  NumberRule rule = kacanov::any_number;
};

/// An integer.
struct Whole {
  int least = 0, most = std::numeric_limits<int>::max();
  std::string words_above = {};  ///< expected text in the message for values above `most`
};

/// A string from a fixed list.
struct Word {
  std::vector<std::string> words;
  std::string expected = {};  ///< expected text in messages; empty: the list of words
};

/// A list whose entries have the same schema.
struct ListOf {
  static constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();
  Schema entry;
  std::string expected;  ///< expected text in messages, as in "a list of 2 or 3 numbers"
  std::size_t least = 0, most = any_number;
  std::string words_below = {}, words_above = {};  ///< for lists of wrong length; empty: `expected`
};

/// A list with one schema per entry.
struct Tuple {
  std::vector<Schema> entries;
  std::string expected;
};

struct Key {
  std::string name;
  Schema value;
  std::string help;  ///< one line of help for users
  bool required = false;
  nlohmann::json fallback = {};  ///< default value; null: no value can express the default
};

/// Exactly one of these keys is present; not `required`: at most one.
struct OneOf {
  std::vector<std::string> keys;
  bool required = true;
};

/// `key` requires `main`; `both`: `main` also requires `key`.
struct Beside {
  std::string key, main;
  bool both = false;
};

/// An object with a fixed set of keys.
struct KeySet {
  std::vector<Key> keys;
  std::vector<OneOf> one_of = {};
  std::vector<Beside> beside = {};
};

/// An object with arbitrary keys.
struct MapOf {
  Schema entry;
  std::string expected;
};

/// An object whose set of keys depends on the word at the key `tag`.
struct Kinds {
  std::string tag;
  std::vector<std::pair<std::string, KeySet>> kinds;  ///< each set includes the tag
};

/// Alternatives with different JSON types; the type of the value selects one.
struct Either {
  std::vector<Schema> choices;
  std::string expected;
};

struct AnyForm {
  std::variant<Text, Flag, Null, Number, Whole, Word, ListOf, Tuple, KeySet, MapOf, Kinds, Either> form;
};

template <class Form>
Schema::Schema(Form form) : form_(std::make_shared<const AnyForm>(AnyForm{std::move(form)})) {}

/// Throws InputError listing every violation with its path and what was expected: unknown keys (with the
/// closest known one), missing keys, wrong types, numbers out of range.
void check(const Node& node, const Schema& schema);

/// Returns the JSON schema (draft 2020-12), including its definitions, with the entries of `heading` first.
nlohmann::ordered_json json_schema(const Schema& schema, nlohmann::ordered_json heading);

}  // namespace kacanov
