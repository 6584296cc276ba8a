// SPDX-License-Identifier: BSD-3-Clause
// Converts an Abaqus or CalculiX deck to a case and its mesh.
#include "program/deck_case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <kacanov/error.hpp>
#include "formats/deck_names.hpp"
#include "formats/printable.hpp"
#include "program/deck_conditions.hpp"
#include "program/deck_materials.hpp"

namespace kacanov {
namespace {

class Converter {
 public:
  Converter(Deck deck, bool leave_out)
      : blocks_(std::move(deck.blocks)),
        deck_(std::move(deck)),
        leave_out_(leave_out),
        materials_(deck_),
        conditions_(deck_, [this](const DeckBlock& block, const std::string& why) { change(block, why); }),
        dim_(conditions_.dimension()),
        names_(deck_) {
    deck_.blocks.clear();
  }

  DeckCase convert() {
    for (const DeckBlock& block : blocks_) take(block);
    const std::string& path = deck_.files[0].path;
    if (!step_) throw InputError(path + ": expected a step, *STEP: this deck is a mesh alone");
    if (deck_.open_step) deck_.fail(*deck_.open_step, "this *STEP has no *END STEP: is the deck cut off?");
    // With --leave-out another procedure, such as *HEAT TRANSFER, may have been skipped.
    if (!have_static_ && !leave_out_) deck_.fail(*step_, "expected *STATIC in this step");
    if (materials_.sections().empty()) throw InputError(path + ": expected a *SOLID SECTION");
    nlohmann::ordered_json document;
    constexpr std::size_t longest_title = 200;
    if (!deck_.title.empty()) document["title"] = printable(shortened(deck_.title, longest_title));
    document["mesh"] = nlohmann::ordered_json::object();
    if (deck_.plane != PlaneState::strain)
      document["plane"] = deck_.plane == PlaneState::stress ? "stress" : "axisymmetric";
    if (const double thickness = materials_.sections()[0].thickness;
        dim_ == 2 && deck_.plane != PlaneState::axisymmetric && thickness != 1.0)
      document["thickness"] = thickness;
    document["material"] = materials();
    document["boundary"] = boundary();
    DeckCase result;
    result.temperatures = add_temperatures(document);
    result.document = std::move(document);
    result.remarks = std::move(remarks_);
    result.places = std::move(places_);
    for (const std::string& warning : deck_.warnings) result.remarks.push_back(warning);
    result.mesh = mesh_of(std::move(deck_));
    refuse_inner_sides(result.mesh);
    return result;
  }

 private:
  using Triple = DeckConditions::Triple;

  void take(const DeckBlock& block) {
    const std::string& name = block.keyword.name;
    if (is_harmless(name)) {
      remarks_.push_back(deck_.place_text(block.keyword.place) + ": " + block.keyword.shown +
                         " is left out, which does not change the answer");
      return;
    }
    const DeckKeywordRule* rule = deck_rule(name);
    if (rule == nullptr) {
      change(block, "it is not known here");
      return;
    }
    if (const std::string fault = level_fault(*rule, block.level); !fault.empty()) {
      change(block, fault);
      return;
    }
    if (name == "STEP") note_step(block);
    if (name == "STATIC") note_static(block);
    for (const std::string& fault : parameter_faults(block.keyword)) change(block, fault);
    if (name == "SOLIDSECTION" && block.keyword.parameter("ORIENTATION") != nullptr)
      remarks_.push_back(deck_.place_text(block.keyword.place) + ": " + block.keyword.shown +
                         ": ORIENTATION is left out, which does not change the answer of isotropic bodies");
    if (!materials_.take(block)) conditions_.take(block);
  }

  /// Reports input that would change the solution if it were skipped.
  void change(const DeckBlock& block, const std::string& why) {
    const std::string text = block.keyword.shown + " changes the answer: " + why;
    if (!leave_out_)
      deck_.fail(block.keyword.place,
                 text + "; --leave-out makes a case without it, to which you add what stands for it");
    remarks_.push_back(deck_.place_text(block.keyword.place) + ": LEFT OUT: " + text);
  }

  void note_step(const DeckBlock& block) {
    if (step_)
      deck_.fail(block.keyword.place,
                 "a second step: expected a deck of one, as the loads of a case go together");
    step_ = block.keyword.place;
    const std::string* nlgeom = block.keyword.parameter("NLGEOM");
    if (nlgeom != nullptr && upper_case(*nlgeom) != "NO")
      change(block, "NLGEOM: displacements and rotations have to be small here");
    if (block.keyword.parameter("PERTURBATION") != nullptr)
      change(block, "PERTURBATION: nothing comes before");
  }

  /// *STATIC sets increments, which do not change the solution.
  void note_static(const DeckBlock& block) {
    if (std::exchange(have_static_, true))
      deck_.fail(block.keyword.place, "a second " + block.keyword.shown + " in this step");
    if (block.keyword.parameter("RIKS") != nullptr) change(block, "RIKS: arc length methods are not known");
    if (block.rows.size() > 1)
      deck_.fail(block.rows[1].place, "expected one line of times, got a second one");
    for (const DeckRow& row : block.rows) {
      deck_.expect_fields(row, 4,
                          "the first increment, the time of the step, the least and largest increment");
      for (std::size_t f = 0; f < row.fields.size(); ++f)
        if (!row.fields[f].empty()) deck_number(deck_, row, f, "a time");
    }
  }

  // Building the case document.

  nlohmann::ordered_json materials() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeckSection& section : materials_.sections()) {
      if (section.thickness != materials_.sections()[0].thickness && dim_ == 2 &&
          deck_.plane != PlaneState::axisymmetric)
        deck_.fail(section.place, "another thickness: expected one for the whole body");
      nlohmann::ordered_json entry{{"on", name_of(section)}};
      entry.update(materials_.entry(section));
      note_places(section, "material[" + std::to_string(list.size()) + "]");
      list.push_back(std::move(entry));
    }
    return list;
  }

  void note_places(const DeckSection& section, const std::string& path) {
    const DeckMaterial& material = materials_.of(section);
    const auto note = [&](const std::string& key, DeckPlace place) {
      places_.emplace_back(path + key, deck_.place_text(place));
    };
    for (std::size_t k = 0; k < material.plastic_rows.size(); ++k)
      note(".plastic[" + std::to_string(k) + "]", material.plastic_rows[k]);
    if (!material.plastic_rows.empty()) note(".plastic", material.plastic_rows[0]);
    note(".young", material.elastic_row);
    note(".poisson", material.elastic_row);
    note("", section.place);
  }

  std::size_t index_of(const DeckSection& section) const {
    const DeckSet* set = deck_.element_set(section.elements, section.in_part);
    if (set == nullptr)
      deck_.fail(section.place,
                 "there is no set of elements " + deck_.quoted(section.place, section.elements));
    if (set->members.empty())
      deck_.fail(section.place,
                 "the set of elements " + deck_.quoted(section.place, section.elements) + " is empty");
    return static_cast<std::size_t>(set - deck_.element_sets.data());
  }

  std::string name_of(const DeckSection& section) {
    return names_.of(deck_.element_sets, deck_.element_sets[index_of(section)].members, "elements");
  }

  nlohmann::ordered_json vector(const Triple& v) const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t c = 0; c < static_cast<std::size_t>(dim_); ++c)
      list.push_back(std::isnan(v[c]) ? nlohmann::ordered_json() : nlohmann::ordered_json(v[c]));
    return list;
  }

  /// Adds one entry for all nodes with the same values.
  void add_node_entries(const std::vector<Triple>& values, const char* key, const char* base,
                        nlohmann::ordered_json& list) {
    std::map<std::array<std::pair<bool, double>, 3>, std::vector<std::int32_t>> groups;
    for (std::size_t n = 0; n < values.size(); ++n) {
      std::array<std::pair<bool, double>, 3> known;
      bool any = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const bool there = !std::isnan(values[n][c]);
        known[c] = {there, there ? values[n][c] : 0.0};
        any = any || (key == std::string("displacement") ? there : known[c].second != 0.0);
      }
      if (any) groups[known].push_back(static_cast<std::int32_t>(n));
    }
    for (const auto& [known, nodes] : groups) {
      Triple value;
      for (std::size_t c = 0; c < 3; ++c)
        value[c] = known[c].first ? known[c].second : DeckConditions::is_free;
      list.push_back({{"on", names_.of(deck_.node_sets, nodes, base)}, {key, vector(value)}});
    }
  }

  nlohmann::ordered_json boundary() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    add_node_entries(conditions_.held(), "displacement", "held", list);
    add_node_entries(conditions_.forces(), "node_force", "loaded", list);
    std::map<double, std::vector<DeckSide>> by_value;
    for (const auto& [side, pressed] : conditions_.pressures())
      if (pressed.value != 0.0) by_value[pressed.value].push_back({side.first, side.second});
    for (const auto& [value, sides] : by_value) {
      const std::string name = names_.of_sides(sides);
      const DeckPlace place = conditions_.pressures().at({sides[0].element, sides[0].side}).place;
      pressed_names_.emplace_back(name, deck_.place_text(place));
      list.push_back({{"on", name}, {"pressure", value}});
    }
    for (const DeckConditions::Gravity& gravity : conditions_.gravity()) add_gravity(gravity, list);
    return list;
  }

  void add_gravity(const DeckConditions::Gravity& gravity, nlohmann::ordered_json& list) {
    const std::vector<DeckSection> sections = materials_.sections();
    for (const DeckSection& section : sections) {
      const std::vector<std::int32_t> mine = deck_.element_sets[index_of(section)].members;
      std::vector<std::int32_t> both;
      std::set_intersection(mine.begin(), mine.end(), gravity.elements.begin(), gravity.elements.end(),
                            std::back_inserter(both));
      if (both.empty()) continue;
      const DeckMaterial& material = materials_.of(section);
      if (!material.density || !(*material.density > 0.0))
        deck_.fail(gravity.place, "GRAV: the material " + deck_.quoted(material.place, material.shown) +
                                      " has no *DENSITY > 0");
      list.push_back({{"on", names_.of(deck_.element_sets, both, "elements")},
                      {"density", *material.density},
                      {"acceleration", vector(gravity.acceleration)}});
    }
  }

  /// Adds one entry if all nodes have the same temperature rise; else returns lines for a nodal file.
  std::string add_temperatures(nlohmann::ordered_json& document) const {
    const auto& list = materials_.sections();
    const bool expands = std::any_of(list.begin(), list.end(), [&](const DeckSection& section) {
      return materials_.of(section).expansion.value_or(0.0) != 0.0;
    });
    if (!expands) return {};
    const std::map<std::int64_t, double> rise = conditions_.temperature_rise();
    if (const auto even = one_value(rise); !even)
      return lines_of(rise);
    else if (*even != 0.0)
      document["boundary"].push_back({{"on", "all"}, {"temperature", *even}});
    return {};
  }

  /// A pressure between two elements would push both of them.
  void refuse_inner_sides(const Mesh& mesh) const {
    for (const auto& [name, place] : pressed_names_)
      for (const Group& group : mesh.groups)
        if (group.name == name && group.inner > 0)
          throw InputError(place + ": " + std::to_string(group.inner) +
                           " of these sides are inside the body, expected sides of its boundary");
  }

  const std::vector<DeckBlock> blocks_;
  Deck deck_;
  bool leave_out_, have_static_ = false;
  std::optional<DeckPlace> step_;
  DeckMaterials materials_;
  DeckConditions conditions_;
  int dim_;
  std::vector<std::pair<std::string, std::string>> pressed_names_;  ///< with their places in the deck
  std::vector<std::pair<std::string, std::string>> places_;
  DeckNames names_;
  std::vector<std::string> remarks_;
};

}  // namespace

std::string DeckCase::with_line(const std::string& message) const {
  for (const auto& [path, place] : places)
    if (message.starts_with(path) &&
        std::string_view(".:[").find(message[path.size()]) != std::string_view::npos)
      return place + ": " + message;
  return message;
}

DeckCase case_of(Deck deck, bool leave_out) { return Converter(std::move(deck), leave_out).convert(); }

}  // namespace kacanov
