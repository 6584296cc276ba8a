// SPDX-License-Identifier: BSD-3-Clause
// Parts and checkpoints with inconsistent fields: the error message names the field.
#include "partition/check_part.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <string>

#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Returns the message of check_part for a changed part, empty if it accepts the part.
std::string complaint(Part part, const std::function<void(Part&)>& change) {
  const int rank = part.node_map.rank, ranks = part.node_map.ranks;
  change(part);
  try {
    check_part(part, rank, ranks);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a part that was split is accepted, and each field that does not fit is named") {
  const Problem problem = build_problem(beam_mesh(2, 8), beam(2, logarithmic_law(0.01), 0.05, 0.1));
  for (const int ranks : {1, 3})
    split(problem, ranks, [&](int, Part&& part) {
      CHECK(complaint(part, [](Part&) {}) == "");
      const std::pair<const char*, std::function<void(Part&)>> faults[] = {
          {"elements", [](Part& p) { p.elements[4] = 1 << 30; }},
          {"elements", [](Part& p) { p.elements[0] = -5; }},
          {"elements", [](Part& p) { p.elements.pop_back(); }},
          {"element type", [](Part& p) { p.type = static_cast<ElementType>(77); }},
          {"coordinates", [](Part& p) { p.coordinates.pop_back(); }},
          {"element numbers", [](Part& p) { p.element_index.runs[0].position = 3; }},
          {"node map", [](Part& p) { p.node_map.owned = 1 << 20; }},
          {"first nodes", [](Part& p) { p.node_map.starts.pop_back(); }},
          {"neighbours",
           [](Part& p) {
             p.node_map.neighbours.push_back({p.node_map.rank, {}, {}, {}});
           }},
          {"shared nodes", [](Part& p) { p.node_map.shared.push_back(1 << 28); }},
          {"node numbers", [](Part& p) { p.node_index[0] = 1 << 29; }},
          {"laws", [](Part& p) { p.laws.clear(); }},
          {"laws of elements", [](Part& p) { p.law_of_element.assign(p.element_count(), 7); }},
          {"loads",
           [](Part& p) {
             p.load.push_back({1 << 29, 1.0});
           }},
          {"held components", [](Part& p) { p.held.pop_back(); }},
          {"prescribed components",
           [](Part& p) {
             p.prescribed.push_back({1 << 29, 1.0});
           }},
          {"held directions",
           [](Part& p) {
             p.directions.push_back({1 << 29, 0, {0, 1, 0}, 0.0});
           }},
          {"held directions",
           [](Part& p) {
             p.directions.assign(4, {1, 0, {0, 1, 0}, 0.0});
           }},
          {"held directions",
           [](Part& p) {
             p.directions.push_back({1, 0, {3, 1, 0}, 0.0});
           }},
          {"springs",
           [](Part& p) {
             p.springs.push_back({-1, 0, {}});
           }},
          {"springs",
           [](Part& p) {
             p.springs.push_back({0, 1 << 29, {}});
           }},
          {"springs",
           [](Part& p) {
             p.springs = {{2, 0, {}}, {1, 0, {}}};
           }},
          {"temperatures",
           [](Part& p) {
             p.thermal.push_back({0, {1.0}});
           }},
          {"start", [](Part& p) { p.start.assign(3, 0.0); }},
          {"numbers of probes", [](Part& p) { p.probe_index.push_back(0); }},
          {"numbers of contact points", [](Part& p) { p.contact_index.push_back(0); }},
          {"contact points", [](Part& p) { p.owned_contact = 1 << 20; }},
      };
      for (const auto& [field, change] : faults) {
        const std::string name = field;
        CAPTURE(name);
        CHECK(complaint(part, change).find("the part's " + name) == 0);
      }
      if (!part.contact.empty()) {
        CHECK(complaint(part, [](Part& p) { p.contact[0].node = 1 << 28; }) != "");
        CHECK(complaint(part, [](Part& p) { p.contact[0].tangents = 9; }) != "");
        CHECK(complaint(part, [](Part& p) { p.contact[0].entry = -1; }) != "");
      }
    });
}

TEST_CASE("a checkpoint's counts are whole and in range") {
  Checkpoint checkpoint;
  for (const double wrong : {-1.0, 0.5, 3.0, 1e18, std::numeric_limits<double>::quiet_NaN()}) {
    checkpoint.numbers["load_steps_over"] = wrong;
    CHECK_THROWS_AS(checkpoint.count("load_steps_over", 2), InputError);
  }
  checkpoint.numbers["load_steps_over"] = 2.0;
  CHECK(checkpoint.count("load_steps_over", 2) == 2);
  CHECK_THROWS_AS(checkpoint.count("missing", 2), InputError);
}
