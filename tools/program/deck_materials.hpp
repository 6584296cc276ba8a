// SPDX-License-Identifier: BSD-3-Clause
// Converts materials and sections of a deck to `material` entries of a case.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/deck.hpp"

namespace kacanov {

struct DeckMaterial {
  DeckPlace place;
  std::string shown;                             ///< name as written in the deck
  std::optional<std::array<double, 2>> elastic;  ///< Young's modulus and Poisson's ratio
  std::vector<std::array<double, 2>> plastic;    ///< stress and plastic strain
  std::optional<double> density, expansion;
  DeckPlace elastic_row = {};
  std::vector<DeckPlace> plastic_rows = {};
};

struct DeckSection {
  DeckPlace place;
  std::string elements;  ///< name of the element set
  std::string material;  ///< in upper case
  double thickness = 1.0;
  bool in_part = false;
};

/// Reads *MATERIAL with its subordinate keywords, and *SOLID SECTION.
class DeckMaterials {
 public:
  explicit DeckMaterials(const Deck& deck) : deck_(deck) {}

  /// Reads the keyword and returns true if it is one of these.
  bool take(const DeckBlock& block);
  /// Returns the material of a section; throws InputError if it does not exist or has no elastic constants.
  const DeckMaterial& of(const DeckSection& section) const;
  const std::vector<DeckSection>& sections() const noexcept { return sections_; }
  /// Returns the `material` entry of a case, without `on`.
  nlohmann::ordered_json entry(const DeckSection& section) const;

 private:
  void expect_constants(const DeckRow& row, std::size_t count, const std::string& what) const;
  void take_elastic(const DeckBlock& block, DeckMaterial& material);
  void take_expansion(const DeckBlock& block, DeckMaterial& material);
  void take_plastic(const DeckBlock& block, DeckMaterial& material);
  void take_section(const DeckBlock& block);

  const Deck& deck_;
  std::map<std::string, DeckMaterial> materials_;  ///< by upper-case name
  std::string current_;
  std::vector<DeckSection> sections_;
};

}  // namespace kacanov
