// SPDX-License-Identifier: BSD-3-Clause
// A JSON value with its path in the document, so that error messages can name the key.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kacanov/model.hpp>

namespace kacanov {

/// Parses one JSON object and rejects repeated keys; comments, // and /* */, are skipped. `label` (the file
/// name) starts every message: InputError "label:line:column: ..." for text that is not JSON.
nlohmann::json parse_json(const std::string& bytes, const std::string& label);

/// A value and its path ("contact[0].friction.tresca"). The value must outlive the node. Every accessor
/// throws InputError "path: expected ..., got ..." if the value has another type or is out of range.
class Node {
 public:
  Node(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

  const std::string& path() const noexcept { return path_; }
  const nlohmann::json& value() const noexcept { return *value_; }

  double number(const NumberRule& rule = any_number) const;
  int integer(int least) const;  ///< integer ≥ least; 1e4 is accepted
  bool boolean() const;
  std::string text() const;                                   ///< non-empty string
  std::vector<Node> list(const std::string& expected) const;  ///< the entries of an array
  std::vector<Node> entries() const { return list("a list"); }
  /// Returns the index of the string in `words`.
  std::size_t choice(const std::vector<std::string_view>& words) const;

  [[noreturn]] void expected(const std::string& what) const;

 private:
  const nlohmann::json* value_;
  std::string path_;
};

/// A JSON object. Its keys are checked against the schema before or after (schema.hpp).
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
