// SPDX-License-Identifier: BSD-3-Clause
// A JSON value that knows its path, so that whatever is wrong with it can be said in the user's terms.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kacanov/rules.hpp>

namespace kacanov {

/// Parses one JSON object, refusing repeated keys; comments, // and /* */, are passed over. `label` (the
/// file's name) starts every message: InputError "label:line:column: ..." for text that is no JSON.
nlohmann::json parse_json(const std::string& bytes, const std::string& label);

/// A value and its path ("contact[0].friction.tresca"). The value must outlive the node. Every accessor
/// throws InputError "path: expected ..., got ..." when the value is something else.
class Node {
 public:
  Node(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

  const std::string& path() const noexcept { return path_; }
  const nlohmann::json& value() const noexcept { return *value_; }

  double number(const NumberRule& rule = any_number) const;
  int integer(int least) const;  ///< a whole number ≥ least, also when written 1e4
  bool boolean() const;
  std::string text() const;                                   ///< a string that is not empty
  std::vector<Node> list(const std::string& expected) const;  ///< the entries of an array
  std::vector<Node> entries() const { return list("a list"); }
  /// A string out of a few; returns its place among them.
  std::size_t choice(const std::vector<std::string_view>& words) const;

  [[noreturn]] void expected(const std::string& what) const;

 private:
  const nlohmann::json* value_;
  std::string path_;
};

/// An object, whose keys have been checked or are about to be (schema.hpp).
class Object {
 public:
  explicit Object(Node node) : node_(std::move(node)) {}
  Node required(const std::string& key) const;
  std::optional<Node> optional(const std::string& key) const;
  std::string path_of(const std::string& key) const;

 private:
  Node node_;
};

}  // namespace kacanov
