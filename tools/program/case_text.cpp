// SPDX-License-Identifier: BSD-3-Clause
// Formats case files for people, for the commands that write them.
#include "program/case_text.hpp"

#include <algorithm>
#include <filesystem>

#include <kacanov/error.hpp>
#include "formats/printable.hpp"

namespace kacanov {
namespace {

/// Writes the value on one line, with a blank after commas and colons.
std::string in_a_row(const nlohmann::ordered_json& value) {
  std::string text;
  if (value.is_object()) {
    for (const auto& [key, entry] : value.items())
      text += (text.empty() ? "{" : ", ") + nlohmann::ordered_json(key).dump() + ": " + in_a_row(entry);
    return text.empty() ? "{}" : text + "}";
  }
  if (!value.is_array()) return value.dump();
  for (const auto& entry : value) text += (text.empty() ? "[" : ", ") + in_a_row(entry);
  return text.empty() ? "[]" : text + "]";
}

bool is_list_of_objects(const nlohmann::ordered_json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const auto& v) { return v.is_object(); });
}

}  // namespace

std::string comment_text(const std::string& text) {
  std::string line = printable(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

std::string case_text(const nlohmann::ordered_json& document, std::span<const std::string> comments) {
  std::string text;
  for (const std::string& comment : comments) text += "// " + comment_text(comment) + "\n";
  text += "{\n";
  std::size_t left = document.size();
  for (const auto& [key, value] : document.items()) {
    text += "  " + nlohmann::ordered_json(key).dump() + ": ";
    if (is_list_of_objects(value)) {
      for (std::size_t i = 0; i < value.size(); ++i)
        text += (i == 0 ? "[\n    " : ",\n    ") + in_a_row(value[i]);
      text += "\n  ]";
    } else {
      text += in_a_row(value);
    }
    text += --left > 0 ? ",\n" : "\n";
  }
  return text + "}\n";
}

void refuse_existing(const std::string& path, bool force) {
  if (!force && std::filesystem::exists(path))
    throw InputError(path + ": there is such a file already; --force writes over it");
}

}  // namespace kacanov
