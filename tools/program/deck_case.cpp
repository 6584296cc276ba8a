// SPDX-License-Identifier: BSD-3-Clause
// From a whole Abaqus or CalculiX deck to a case and its mesh.
#include "program/deck_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <kacanov/error.hpp>
#include "formats/deck_names.hpp"
#include "formats/deck_temperatures.hpp"
#include "formats/gmsh_cursor.hpp"
#include "program/deck_materials.hpp"

namespace kacanov {
namespace {

using Triple = std::array<double, 3>;

constexpr double is_free = std::numeric_limits<double>::quiet_NaN();

class Converter {
 public:
  Converter(Deck deck, bool leave_out)
      : blocks_(std::move(deck.blocks)),
        deck_(std::move(deck)),
        leave_out_(leave_out),
        materials_(deck_),
        temperatures_(deck_),
        names_(deck_) {
    deck_.blocks.clear();
    for (const Deck::Element& element : deck_.elements) dim_ = std::max(dim_, cells()[element.cell].dim);
    in_body_.resize(deck_.content.node_tags.size());
    for (std::size_t c = 0; c < cells().size(); ++c)
      if (cells()[c].dim == dim_)
        for (const std::int32_t node : deck_.content.elements[c].nodes) in_body_[node] = true;
  }

  DeckCase convert() {
    for (const DeckBlock& block : blocks_) take(block);
    if (!have_step_) throw InputError(deck_.files[0] + ": expected a step, *STEP: this deck is a mesh alone");
    if (materials_.sections().empty()) throw InputError(deck_.files[0] + ": expected a *SOLID SECTION");
    nlohmann::ordered_json document;
    if (!deck_.title.empty()) document["title"] = deck_.title.substr(0, 200);
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
    for (const std::string& warning : deck_.warnings) result.remarks.push_back(warning);
    result.mesh = mesh_of(std::move(deck_));
    refuse_inner_sides(result.mesh);
    return result;
  }

 private:
  using Row = const DeckRow&;

  void take(const DeckBlock& block) {
    const std::string& name = block.keyword.name;
    if (materials_.take(block)) return;
    if (name == "STEP") {
      take_step(block);
    } else if (name == "STATIC") {
      if (block.keyword.parameter("RIKS") != nullptr) change(block, "arc length methods are not known");
    } else if (name == "BOUNDARY") {
      take_boundary(block);
    } else if (name == "CLOAD" || name == "DLOAD" || name == "DSLOAD") {
      take_load(block);
    } else if (is_harmless(name)) {
      remarks_.push_back(deck_.place_text(block.keyword.place) + ": " + block.keyword.shown +
                         " is left out, which does not change the answer");
    } else if (name == "TEMPERATURE") {
      take_temperatures(block, temperatures_.at_end);
    } else if (name == "INITIALCONDITIONS") {
      const std::string* type = block.keyword.parameter("TYPE");
      if (type != nullptr && upper_case(*type) == "TEMPERATURE")
        take_temperatures(block, temperatures_.at_start);
      else
        change(block, "it is not known here, but TYPE=TEMPERATURE");
    } else {
      change(block, "it is not known here");
    }
  }

  /// For what would give another answer if it were left out.
  void change(const DeckBlock& block, const std::string& why) {
    const std::string text = block.keyword.shown + " changes the answer: " + why;
    if (!leave_out_)
      deck_.fail(block.keyword.place,
                 text + "; --leave-out makes a case without it, to which you add what stands for it");
    remarks_.push_back(deck_.place_text(block.keyword.place) + ": LEFT OUT: " + text);
  }

  void take_step(const DeckBlock& block) {
    if (std::exchange(have_step_, true))
      deck_.fail(block.keyword.place,
                 "a second step: expected a deck of one, as the loads of a case go together");
    const std::string* nlgeom = block.keyword.parameter("NLGEOM");
    if (nlgeom != nullptr && upper_case(*nlgeom) != "NO")
      change(block, "NLGEOM: displacements and rotations have to be small here");
    if (block.keyword.parameter("PERTURBATION") != nullptr)
      change(block, "PERTURBATION: nothing comes before");
  }

  /// Parameters that make another condition of one.
  void refuse_parameters(const DeckBlock& block) {
    static const std::set<std::string> known{"OP", "REGION", "NAME"};
    for (const auto& [name, value] : block.keyword.parameters) {
      // What the model holds is let go; of loads there are none before the one step.
      const bool lets_go =
          name == "OP" && upper_case(value) == "NEW" && block.keyword.name == "BOUNDARY" && have_step_;
      if (!known.contains(name) || lets_go)
        change(block, name + (value.empty() ? "" : "=" + value) + " is not known here");
    }
  }

  void take_boundary(const DeckBlock& block) {
    refuse_parameters(block);
    held_.resize(deck_.content.node_tags.size(), {is_free, is_free, is_free});
    for (Row row : block.rows) {
      const std::vector<std::int32_t> nodes = deck_.nodes_of(row.fields[0], row.place, block.in_part);
      const std::string word = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
      static const std::map<std::string, std::pair<int, int>> words{
          {"ENCASTRE", {1, 3}}, {"PINNED", {1, 3}}, {"XSYMM", {1, 1}}, {"YSYMM", {2, 2}}, {"ZSYMM", {3, 3}}};
      if (const auto known = words.find(word); known != words.end()) {
        hold(nodes, known->second.first, known->second.second, 0.0);
        continue;
      }
      const std::int64_t first = deck_integer(deck_, row, 1, "a degree of freedom"),
                         last = row.fields.size() > 2 && !row.fields[2].empty()
                                    ? deck_integer(deck_, row, 2, "the last degree of freedom")
                                    : first;
      const double value = row.fields.size() > 3 && !row.fields[3].empty()
                               ? deck_number(deck_, row, 3, "a displacement")
                               : 0.0;
      if (first < 1 || last < first || last > 6)
        deck_.fail(row.place,
                   "expected degrees of freedom 1 to 3 (4 to 6, rotations, say nothing of solids), got " +
                       std::to_string(first) + " to " + std::to_string(last));
      if (last > dim_ && first <= 3 && dim_ == 2 && value != 0.0)
        deck_.fail(row.place, "a plane body does not move across its plane");
      hold(nodes, static_cast<int>(first), static_cast<int>(last), value);
    }
  }

  /// What is said later of a node takes the place of what was said before.
  void hold(const std::vector<std::int32_t>& nodes, int first, int last, double value) {
    for (const std::int32_t node : nodes)
      for (int c = first; c <= std::min(last, dim_) && in_body_[node]; ++c)
        held_[node][static_cast<std::size_t>(c) - 1] = value;
  }

  /// Loads of a step add up, as in CalculiX.
  void take_load(const DeckBlock& block) {
    refuse_parameters(block);
    for (Row row : block.rows) {
      if (block.keyword.name == "CLOAD")
        take_point_load(row, block.in_part);
      else if (block.keyword.name == "DLOAD")
        take_element_load(block, row);
      else
        take_surface_load(block, row);
    }
  }

  void take_temperatures(const DeckBlock& block, std::vector<double>& of_node) {
    static const std::set<std::string> known{"OP", "REGION", "NAME", "TYPE"};
    for (const auto& [name, value] : block.keyword.parameters)
      if (!known.contains(name))
        change(block, name + (value.empty() ? "" : "=" + value) + " is not known here");
    temperatures_.take(block, of_node);
  }

  void take_point_load(Row row, bool in_part) {
    forces_.resize(deck_.content.node_tags.size(), Triple{});
    const std::int64_t direction = deck_integer(deck_, row, 1, "a degree of freedom");
    if (direction < 1 || direction > dim_)
      deck_.fail(row.place, "expected a degree of freedom 1 to " + std::to_string(dim_) + ", got " +
                                std::to_string(direction) + ": moments do not act on nodes of solids");
    const double value = deck_number(deck_, row, 2, "a force");
    for (const std::int32_t node : deck_.nodes_of(row.fields[0], row.place, in_part)) {
      if (!in_body_[node])
        deck_.fail(row.place, "node " + std::to_string(deck_.content.node_tags[node]) +
                                  " is loaded and belongs to no element of the body");
      forces_[node][static_cast<std::size_t>(direction) - 1] += value;
    }
  }

  void take_element_load(const DeckBlock& block, Row row) {
    const std::string label = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
    std::vector<std::int32_t> elements(deck_.elements.size());
    std::iota(elements.begin(), elements.end(), 0);
    if (!row.fields[0].empty()) elements = deck_.elements_of(row.fields[0], row.place, block.in_part);
    if (label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6') {
      const double value = deck_number(deck_, row, 2, "a pressure");
      for (const std::int32_t element : elements) press({element, label[1] - '1'}, row.place, value);
    } else if (label == "GRAV") {
      Triple direction{};
      for (std::size_t c = 0; c < 3; ++c)
        direction[c] = 3 + c < row.fields.size() ? deck_number(deck_, row, 3 + c, "a direction") : 0.0;
      const double length = std::hypot(direction[0], direction[1], direction[2]);
      if (!(length > 0.0)) deck_.fail(row.place, "expected a direction of gravity");
      const double value = deck_number(deck_, row, 2, "an acceleration");
      for (double& component : direction) component *= value / length;
      gravity_.push_back({row.place, std::move(elements), direction});
    } else {
      change(block, "loads of the kind " + in_quotes(label) + " are not known here, but P1 to P6 and GRAV");
    }
  }

  void take_surface_load(const DeckBlock& block, Row row) {
    const std::string label = row.fields.size() > 1 ? upper_case(row.fields[1]) : std::string();
    if (label != "P") {
      change(block, "loads of the kind " + in_quotes(label) + " are not known here, but P");
      return;
    }
    const DeckSurface* surface = deck_.surface(row.fields[0], block.in_part);
    if (surface == nullptr) deck_.fail(row.place, "there is no surface " + in_quotes(row.fields[0]));
    const double value = deck_number(deck_, row, 2, "a pressure");
    for (const DeckSide& side : surface->sides) press(side, row.place, value);
  }

  void press(DeckSide side, DeckPlace place, double value) {
    deck_.side_nodes(side, place);  // says so where there is none
    Pressed& there = pressed_[{side.element, side.side}];
    there.value += value;
    there.place = place;
  }

  // What the case says.

  nlohmann::ordered_json materials() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeckSection& section : materials_.sections()) {
      if (section.thickness != materials_.sections()[0].thickness && dim_ == 2 &&
          deck_.plane != PlaneState::axisymmetric)
        deck_.fail(section.place, "another thickness: expected one for the whole body");
      nlohmann::ordered_json entry{{"on", name_of(section)}};
      entry.update(materials_.entry(section));
      list.push_back(std::move(entry));
    }
    return list;
  }

  std::size_t index_of(const DeckSection& section) const {
    const DeckSet* set = deck_.element_set(section.elements, section.in_part);
    if (set == nullptr)
      deck_.fail(section.place, "there is no set of elements " + in_quotes(section.elements));
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

  /// One entry for all nodes that have the same values.
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
      for (std::size_t c = 0; c < 3; ++c) value[c] = known[c].first ? known[c].second : is_free;
      list.push_back({{"on", names_.of(deck_.node_sets, nodes, base)}, {key, vector(value)}});
    }
  }

  nlohmann::ordered_json boundary() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    add_node_entries(held_, "displacement", "held", list);
    add_node_entries(forces_, "node_force", "loaded", list);
    std::map<double, std::vector<DeckSide>> by_value;
    for (const auto& [side, pressed] : pressed_)
      if (pressed.value != 0.0) by_value[pressed.value].push_back({side.first, side.second});
    for (const auto& [value, sides] : by_value) {
      const std::string name = names_.of_sides(sides);
      pressed_names_.emplace_back(name,
                                  deck_.place_text(pressed_.at({sides[0].element, sides[0].side}).place));
      list.push_back({{"on", name}, {"pressure", value}});
    }
    for (const Gravity& gravity : gravity_) add_gravity(gravity, list);
    return list;
  }

  struct Gravity {
    DeckPlace place;
    std::vector<std::int32_t> elements;
    Triple acceleration;
  };

  void add_gravity(const Gravity& gravity, nlohmann::ordered_json& list) {
    const std::vector<DeckSection> sections = materials_.sections();
    for (const DeckSection& section : sections) {
      const std::vector<std::int32_t> mine = deck_.element_sets[index_of(section)].members;
      std::vector<std::int32_t> both;
      std::set_intersection(mine.begin(), mine.end(), gravity.elements.begin(), gravity.elements.end(),
                            std::back_inserter(both));
      if (both.empty()) continue;
      const DeckMaterial& material = materials_.of(section);
      if (!material.density || !(*material.density > 0.0))
        deck_.fail(gravity.place, "GRAV: the material " + in_quotes(material.shown) + " has no *DENSITY > 0");
      list.push_back({{"on", names_.of(deck_.element_sets, both, "elements")},
                      {"density", *material.density},
                      {"acceleration", vector(gravity.acceleration)}});
    }
  }

  /// An entry where all nodes are warmer by the same, else lines for a file.
  std::string add_temperatures(nlohmann::ordered_json& document) const {
    const auto& list = materials_.sections();
    const bool expands = std::any_of(list.begin(), list.end(), [&](const DeckSection& section) {
      return materials_.of(section).expansion.value_or(0.0) != 0.0;
    });
    if (!expands) return {};
    const std::map<std::int64_t, double> rise = temperatures_.rise(in_body_);
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

  struct Pressed {
    double value = 0.0;
    DeckPlace place;
  };

  const std::vector<DeckBlock> blocks_;
  Deck deck_;
  bool leave_out_, have_step_ = false;
  int dim_ = 2;
  DeckMaterials materials_;
  std::vector<bool> in_body_;          ///< by node
  std::vector<Triple> held_, forces_;  ///< by node; empty where nothing is
  DeckTemperatures temperatures_;
  std::map<std::pair<std::int32_t, std::int32_t>, Pressed> pressed_;
  std::vector<std::pair<std::string, std::string>> pressed_names_;  ///< with their places
  std::vector<Gravity> gravity_;
  DeckNames names_;
  std::vector<std::string> remarks_;
};

}  // namespace

DeckCase case_of(Deck deck, bool leave_out) { return Converter(std::move(deck), leave_out).convert(); }

}  // namespace kacanov
