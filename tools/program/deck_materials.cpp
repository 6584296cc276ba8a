// SPDX-License-Identifier: BSD-3-Clause
// Converts materials and sections of a deck to `material` entries of a case.
#include "program/deck_materials.hpp"

namespace kacanov {

bool DeckMaterials::take(const DeckBlock& block) {
  const std::string& name = block.keyword.name;
  if (name == "SOLIDSECTION") {
    take_section(block);
    return true;
  }
  if (name == "MATERIAL") {
    const std::string* parameter = block.keyword.parameter("NAME");
    if (parameter == nullptr || parameter->empty())
      deck_.fail(block.keyword.place, block.keyword.shown + ": expected NAME=<name>");
    current_ = upper_case(*parameter);
    DeckMaterial material;
    material.place = block.keyword.place;
    material.shown = *parameter;
    if (!materials_.emplace(current_, material).second)
      deck_.fail(block.keyword.place, "a second material " + deck_.quoted(block.keyword.place, *parameter));
    if (!block.rows.empty())
      deck_.fail(block.rows[0].place, block.keyword.shown + " has no lines of data, got " +
                                          deck_.quoted(block.rows[0].place, block.rows[0].fields[0]));
    return true;
  }
  if (name != "ELASTIC" && name != "PLASTIC" && name != "DENSITY" && name != "EXPANSION") return false;
  if (current_.empty()) deck_.fail(block.keyword.place, block.keyword.shown + " before any *MATERIAL");
  if (block.rows.empty())
    deck_.fail(block.keyword.place, block.keyword.shown + ": expected a line of numbers");
  DeckMaterial& material = materials_.at(current_);
  if ((name == "ELASTIC" && material.elastic) || (name == "PLASTIC" && !material.plastic.empty()) ||
      (name == "DENSITY" && material.density) || (name == "EXPANSION" && material.expansion))
    deck_.fail(block.keyword.place, "a second " + block.keyword.shown + " of the material " +
                                        deck_.quoted(material.place, material.shown) + ": expected one");
  if (name == "ELASTIC") take_elastic(block, material);
  if (name == "PLASTIC") take_plastic(block, material);
  if (name == "EXPANSION") take_expansion(block, material);
  if (name == "DENSITY") {
    if (block.rows.size() > 1) deck_.fail(block.rows[1].place, "expected one density, at all temperatures");
    expect_constants(block.rows[0], 1, "a density");
    material.density = deck_number(deck_, block.rows[0], 0, "a density");
  }
  return true;
}

void DeckMaterials::take_elastic(const DeckBlock& block, DeckMaterial& material) {
  const std::string* type = block.keyword.parameter("TYPE");
  const std::string kind = type == nullptr ? "ISO" : upper_case(*type);
  if (kind != "ISO" && kind != "ISOTROPIC")
    deck_.fail(block.keyword.place, block.keyword.shown + ": expected an isotropic material, got " +
                                        block.keyword.written({"TYPE", kind}));
  if (block.rows.size() > 1)
    deck_.fail(block.rows[1].place, "expected one Young's modulus and Poisson's ratio, at all temperatures");
  expect_constants(block.rows[0], 2, "Young's modulus and Poisson's ratio");
  material.elastic = {deck_number(deck_, block.rows[0], 0, "Young's modulus"),
                      deck_number(deck_, block.rows[0], 1, "Poisson's ratio")};
  material.elastic_row = block.rows[0].place;
}

/// A temperature may follow the constants; a single row applies to all temperatures.
void DeckMaterials::expect_constants(const DeckRow& row, std::size_t count, const std::string& what) const {
  deck_.expect_fields(row, count + 1, what + " and a temperature");
  if (row.fields.size() > count && !row.fields[count].empty())
    deck_number(deck_, row, count, "a temperature");
}

/// With a single coefficient the reference temperature ZERO does not matter.
void DeckMaterials::take_expansion(const DeckBlock& block, DeckMaterial& material) {
  const std::string* type = block.keyword.parameter("TYPE");
  const std::string kind = type == nullptr ? "ISO" : upper_case(*type);
  if (kind != "ISO" && kind != "ISOTROPIC")
    deck_.fail(block.keyword.place, block.keyword.shown + ": expected an isotropic material, got " +
                                        block.keyword.written({"TYPE", kind}));
  if (const std::string* zero = block.keyword.parameter("ZERO"); zero != nullptr && !deck_real(*zero))
    deck_.fail(block.keyword.place, block.keyword.shown + ": expected a temperature ZERO, got " +
                                        deck_.quoted(block.keyword.place, *zero));
  material.expansion = deck_number(deck_, block.rows[0], 0, "a coefficient of expansion");
  for (const DeckRow& row : block.rows) {
    expect_constants(row, 1, "a coefficient of expansion");
    if (deck_number(deck_, row, 0, "a coefficient of expansion") != *material.expansion)
      deck_.fail(row.place, "expected one coefficient of expansion, at all temperatures");
  }
}

void DeckMaterials::take_plastic(const DeckBlock& block, DeckMaterial& material) {
  const std::string* hardening = block.keyword.parameter("HARDENING");
  const std::string kind = hardening == nullptr ? "ISOTROPIC" : upper_case(*hardening);
  // The two are equivalent under monotonic loading.
  if (kind != "ISOTROPIC" && kind != "KINEMATIC")
    deck_.fail(block.keyword.place, block.keyword.shown +
                                        ": expected HARDENING=ISOTROPIC or KINEMATIC, got " +
                                        block.keyword.written({"HARDENING", kind}));
  const auto temperature = [&](const DeckRow& row) {
    return row.fields.size() > 2 && !row.fields[2].empty() ? deck_number(deck_, row, 2, "a temperature")
                                                           : 0.0;
  };
  for (const DeckRow& row : block.rows) {
    deck_.expect_fields(row, 3, "a stress, a plastic strain and a temperature");
    if (temperature(row) != temperature(block.rows[0]))
      deck_.fail(row.place, "expected one curve, at all temperatures");
    material.plastic.push_back(
        {deck_number(deck_, row, 0, "a stress"), row.fields.size() > 1 && !row.fields[1].empty()
                                                     ? deck_number(deck_, row, 1, "a plastic strain")
                                                     : 0.0});
    material.plastic_rows.push_back(row.place);
  }
}

void DeckMaterials::take_section(const DeckBlock& block) {
  DeckSection section;
  section.place = block.keyword.place;
  section.in_part = block.in_part;
  for (const auto& [parameter, to] :
       {std::pair("ELSET", &section.elements), std::pair("MATERIAL", &section.material)}) {
    const std::string* value = block.keyword.parameter(parameter);
    if (value == nullptr || value->empty())
      deck_.fail(section.place, block.keyword.shown + ": expected " + parameter + "=<name>");
    *to = *value;
  }
  section.material = upper_case(section.material);
  if (block.rows.size() > 1)
    deck_.fail(block.rows[1].place, "expected one line, a thickness, got a second one");
  if (!block.rows.empty()) deck_.expect_fields(block.rows[0], 1, "a thickness");
  if (!block.rows.empty() && !block.rows[0].fields[0].empty())
    section.thickness = deck_number(deck_, block.rows[0], 0, "a thickness");
  if (!(section.thickness > 0.0)) deck_.fail(block.rows[0].place, "expected a thickness > 0");
  sections_.push_back(section);
}

const DeckMaterial& DeckMaterials::of(const DeckSection& section) const {
  const auto found = materials_.find(section.material);
  if (found == materials_.end())
    deck_.fail(section.place, "there is no material " + deck_.quoted(section.place, section.material));
  if (!found->second.elastic)
    deck_.fail(found->second.place,
               "the material " + deck_.quoted(found->second.place, found->second.shown) + " has no *ELASTIC");
  return found->second;
}

nlohmann::ordered_json DeckMaterials::entry(const DeckSection& section) const {
  const DeckMaterial& material = of(section);
  nlohmann::ordered_json entry{{"young", (*material.elastic)[0]}, {"poisson", (*material.elastic)[1]}};
  if (!material.plastic.empty()) entry["plastic"] = material.plastic;
  if (material.expansion) entry["expansion"] = *material.expansion;
  return entry;
}

}  // namespace kacanov
