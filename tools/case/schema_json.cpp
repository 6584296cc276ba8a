// SPDX-License-Identifier: BSD-3-Clause
// Converts a schema to a JSON schema, draft 2020-12.
#include <algorithm>

#include "case/schema.hpp"

namespace kacanov {
namespace {

using nlohmann::ordered_json;

ordered_json type(const char* name) { return {{"type", name}}; }

class SchemaWriter {
 public:
  ordered_json of(const Schema& schema) {
    if (schema.name().empty()) return in_full(schema);
    if (!definitions_.contains(schema.name())) {
      ordered_json definition = in_full(schema);
      definitions_[schema.name()] = std::move(definition);
    }
    return {{"$ref", "#/$defs/" + schema.name()}};
  }
  /// Valid once all schemas have been written.
  const ordered_json& definitions() const { return definitions_; }

  ordered_json operator()(const Text& text) {
    const std::string controls =
        text.lines ? "\\u0000-\\u0008\\u000b\\u000c\\u000e-\\u001f" : "\\u0000-\\u001f";
    const std::string refused = "[" + controls + "\\u007f-\\u009f\\u2028-\\u202e\\u2066-\\u2069]";
    return {{"type", "string"}, {"minLength", 1}, {"not", {{"pattern", refused}}}};
  }
  ordered_json operator()(const Flag&) { return type("boolean"); }
  ordered_json operator()(const Null&) { return type("null"); }
  ordered_json operator()(const Number& form) {
    ordered_json schema = type("number");
    const NumberRule& rule = form.rule;
    if (rule.above >= -largest_number)
      schema["exclusiveMinimum"] = rule.above;
    else
      schema["minimum"] = std::max(rule.least, -largest_number);
    if (rule.below <= largest_number)
      schema["exclusiveMaximum"] = rule.below;
    else
      schema["maximum"] = std::min(rule.most, largest_number);
    return schema;
  }
  ordered_json operator()(const Whole& form) {
    return {{"type", "integer"}, {"minimum", form.least}, {"maximum", form.most}};
  }
  ordered_json operator()(const Word& form) {
    if (form.words.size() == 1) return {{"const", form.words.front()}};
    return {{"enum", form.words}};
  }
  ordered_json operator()(const ListOf& form) {
    ordered_json schema = type("array");
    schema["items"] = of(form.entry);
    if (form.least > 0) schema["minItems"] = form.least;
    if (form.most != ListOf::any_number) schema["maxItems"] = form.most;
    return schema;
  }
  ordered_json operator()(const Tuple& form) {
    ordered_json schema = type("array"), entries = ordered_json::array();
    for (const Schema& entry : form.entries) entries.push_back(of(entry));
    schema["prefixItems"] = std::move(entries);
    schema["items"] = false;
    schema["minItems"] = form.entries.size();
    return schema;
  }
  ordered_json operator()(const MapOf& form) {
    return {{"type", "object"}, {"additionalProperties", of(form.entry)}};
  }
  ordered_json operator()(const Either& form) {
    ordered_json choices = ordered_json::array();
    for (const Schema& schema : form.choices) choices.push_back(of(schema));
    return {{"anyOf", std::move(choices)}};
  }
  ordered_json operator()(const Kinds& form) {
    ordered_json kinds = ordered_json::array(), tags = ordered_json::array();
    for (const auto& [name, keys] : form.kinds) {
      tags.push_back(name);
      kinds.push_back((*this)(keys));
    }
    return {{"type", "object"},
            {"required", ordered_json::array({form.tag})},
            {"properties", {{form.tag, {{"enum", std::move(tags)}}}}},
            {"oneOf", std::move(kinds)}};
  }
  ordered_json operator()(const KeySet& set) {
    ordered_json schema = type("object"), properties = ordered_json::object();
    ordered_json required = ordered_json::array();
    for (const Key& key : set.keys) {
      ordered_json property = of(key.value);
      property["description"] = key.help;
      if (!key.fallback.is_null()) property["default"] = key.fallback;
      properties[key.name] = std::move(property);
      if (key.required) required.push_back(key.name);
    }
    schema["properties"] = std::move(properties);
    schema["additionalProperties"] = false;
    if (!required.empty()) schema["required"] = std::move(required);
    for (const OneOf& group : set.one_of) schema["allOf"].push_back(one_of(group));
    for (const Beside& pair : set.beside) {
      schema["dependentRequired"][pair.key].push_back(pair.main);
      if (pair.both) schema["dependentRequired"][pair.main].push_back(pair.key);
    }
    return schema;
  }

 private:
  ordered_json in_full(const Schema& schema) { return std::visit(*this, schema.form().form); }
  static ordered_json one_of(const OneOf& group) {
    ordered_json choices = ordered_json::array();
    for (const std::string& key : group.keys) choices.push_back({{"required", ordered_json::array({key})}});
    if (!group.required) choices.push_back({{"not", {{"anyOf", choices}}}});
    return {{"oneOf", std::move(choices)}};
  }

  ordered_json definitions_ = ordered_json::object();
};

}  // namespace

Schema Schema::named(std::string name) const {
  Schema copy = *this;
  copy.name_ = std::move(name);
  return copy;
}

ordered_json json_schema(const Schema& schema, ordered_json heading) {
  SchemaWriter writer;
  ordered_json json = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
  json.update(heading);
  json.update(writer.of(schema));
  json["$defs"] = writer.definitions();
  return json;
}

}  // namespace kacanov
