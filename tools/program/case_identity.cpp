// SPDX-License-Identifier: BSD-3-Clause
// Compares two case files section by section and names the keys that differ.
#include "program/case_identity.hpp"

#include <sstream>

namespace kacanov {
namespace {

using nlohmann::json;

/// "/material/0/young" as material[0].young.
std::string key_path(const std::string& pointer) {
  std::string path, word;
  std::istringstream words(pointer);
  std::getline(words, word, '/');
  while (std::getline(words, word, '/')) {
    const bool number = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    path += number ? "[" + word + "]" : (path.empty() ? "" : ".") + word;
  }
  return path;
}

std::string value_at(const json& document, const std::string& pointer) {
  const json::json_pointer place(pointer);
  if (!document.contains(place)) return "nothing";
  const std::string text = document.at(place).dump();
  return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

/// The first keys of a section that differ, in the words of the case files.
std::string differing_keys(const json& there, const json& here, const std::string& section) {
  constexpr int most = 3;
  std::string text;
  int found = 0;
  for (const json& change : json::diff(there, here)) {
    const std::string pointer = change.at("path");
    if (pointer != "/" + section && pointer.rfind("/" + section + "/", 0) != 0) continue;
    if (++found > most) return text + ", ...";
    text += (text.empty() ? "" : ", ") + key_path(pointer) + ": " + value_at(there, pointer) + " there, " +
            value_at(here, pointer) + " here";
  }
  return text;
}

}  // namespace

json case_sections(const json& document, std::span<const char* const> sections) {
  json some = json::object();
  for (const char* section : sections)
    if (document.contains(section)) some[section] = document[section];
  return some;
}

std::vector<std::string> differing_sections(const json& there, const json& here,
                                            std::span<const char* const> sections) {
  std::vector<std::string> names;
  for (const char* section : sections)
    if (there.value(section, json()) != here.value(section, json())) names.emplace_back(section);
  return names;
}

std::string describe_differences(const json& there, const json& here, std::span<const std::string> sections) {
  std::string text;
  for (const std::string& section : sections) {
    const std::string keys = differing_keys(there, here, section);
    text += (text.empty() ? "" : "; ") + section + " differs" + (keys.empty() ? "" : " (" + keys + ")");
  }
  return text;
}

json fingerprint_json(const Fingerprint& print) {
  json out = json::object();
  for (const auto& [name, hash] : print.sections) out[name] = hash;
  return out;
}

Fingerprint parse_fingerprint(const json& json) {
  Fingerprint print;
  for (const auto& [name, hash] : json.items()) print.sections[name] = hash.get<std::uint64_t>();
  return print;
}

}  // namespace kacanov
