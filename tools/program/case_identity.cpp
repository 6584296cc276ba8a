// SPDX-License-Identifier: BSD-3-Clause
// Compares two case files section by section and names the keys that differ.
#include "program/case_identity.hpp"

#include "mesh/classic_locale_stream.hpp"

namespace kacanov {
namespace {

/// Converts "/material/0/young" to material[0].young.
std::string key_path(const std::string& pointer) {
  std::string path, word;
  PlainWords words(pointer);
  std::getline(words, word, '/');
  while (std::getline(words, word, '/')) {
    const bool number = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    path += number ? "[" + word + "]" : (path.empty() ? "" : ".") + word;
  }
  return path;
}

std::string value_at(const nlohmann::json& document, const std::string& pointer) {
  const nlohmann::json::json_pointer place(pointer);
  if (!document.contains(place)) return "nothing";
  const std::string text = document.at(place).dump();
  return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

/// Returns the first differing keys of a section, with both values.
std::string differing_keys(const nlohmann::json& there, const nlohmann::json& here,
                           const std::string& section) {
  constexpr int most = 3;
  std::string text;
  int found = 0;
  for (const nlohmann::json& change : nlohmann::json::diff(there, here)) {
    const std::string pointer = change.at("path");
    if (pointer != "/" + section && pointer.rfind("/" + section + "/", 0) != 0) continue;
    if (++found > most) return text + ", ...";
    text += (text.empty() ? "" : ", ") + key_path(pointer) + ": " + value_at(there, pointer) + " there, " +
            value_at(here, pointer) + " here";
  }
  return text;
}

}  // namespace

nlohmann::json case_sections(const nlohmann::json& document, std::span<const char* const> sections) {
  nlohmann::json some = nlohmann::json::object();
  for (const char* section : sections)
    if (document.contains(section)) some[section] = document[section];
  return some;
}

std::vector<std::string> differing_sections(const nlohmann::json& there, const nlohmann::json& here,
                                            std::span<const char* const> sections) {
  std::vector<std::string> names;
  for (const char* section : sections)
    if (there.value(section, nlohmann::json()) != here.value(section, nlohmann::json()))
      names.emplace_back(section);
  return names;
}

std::string describe_differences(const nlohmann::json& there, const nlohmann::json& here,
                                 std::span<const std::string> sections) {
  std::string text;
  for (const std::string& section : sections) {
    const std::string keys = differing_keys(there, here, section);
    text += (text.empty() ? "" : "; ") + section + " differs" + (keys.empty() ? "" : " (" + keys + ")");
  }
  return text;
}

nlohmann::json fingerprint_json(const Fingerprint& print) {
  nlohmann::json out = nlohmann::json::object();
  for (const auto& [name, hash] : print.sections) out[name] = hash;
  return out;
}

Fingerprint parse_fingerprint(const nlohmann::json& json) {
  Fingerprint print;
  for (const auto& [name, hash] : json.items()) print.sections[name] = hash.get<std::uint64_t>();
  return print;
}

}  // namespace kacanov
