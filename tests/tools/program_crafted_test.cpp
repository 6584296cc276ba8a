// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints and boundaries with a correct hash and wrong content: rejected with file and entry.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <kacanov/error.hpp>

#include "program/check_boundary.hpp"
#include "program/hashed_file.hpp"
#include "program_runner.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// The content of a checkpoint file, which tests change and write back with a matching hash.
struct RawCheckpoint {
  nlohmann::json header;
  std::map<std::string, std::vector<double>> fields;

  void set(const std::string& name, double value) {
    header["numbers"][name] = std::bit_cast<std::uint64_t>(value);
  }
};

void change_checkpoint(const std::string& file, const std::function<void(RawCheckpoint&)>& change) {
  const std::string text = contents(file), magic = text.substr(0, text.find('\n') + 1);
  RawCheckpoint raw;
  {
    HashedReader reader(file, magic, "checkpoint");
    raw.header = reader.header();
    for (const auto& [name, count] : raw.header["fields"].items()) {
      auto& field = raw.fields[name];
      field.resize(count.get<std::size_t>());
      reader.read(field.data(), field.size() * sizeof(double));
    }
  }
  change(raw);
  HashedWriter writer(file, magic, raw.header);
  for (const auto& [name, values] : raw.fields) writer.write(values.data(), values.size() * sizeof(double));
  writer.commit();
}

/// A square of two triangles with contact at its bottom, as stored beside the parts.
Problem small_boundary(std::vector<std::int32_t>& nodes, Part& whole) {
  Model model;
  model.materials.push_back({Selector{}, elastic_law(1.0, 0.3)});
  BoundaryEntry held;
  held.on.kind = Selector::Kind::name;
  held.on.name = "left";
  held.displacement = std::array<std::optional<double>, 3>{0.0, 0.0};
  model.boundary.push_back(held);
  ContactEntry contact;
  contact.on.kind = Selector::Kind::name;
  contact.on.name = "bottom";
  contact.obstacle = ConstantGap{0.1};
  model.contact.push_back(contact);
  Problem problem = build_problem(make_box({{1, 1, 1}, {1, 1, 1}, ElementType::tri3}), model);
  split(problem, 1, [&](int, Part&& part) { whole = std::move(part); });
  nodes = keep_boundary(problem);
  return problem;
}

}  // namespace

TEST_CASE(
    "checkpoints with a right hash and a header or numbers that cannot be are refused by file and name") {
  const Workplace place;
  place.put_json("beam.json", small_beam());
  REQUIRE(place.run("run beam.json --output out --set solver.max_outer=2").exit_code == 1);
  const std::string file = place.path("out/checkpoint.kacanov").string(), whole = contents(file);
  struct Change {
    std::string words;
    std::function<void(RawCheckpoint&)> make;
  };
  std::vector<Change> changes;
  for (const double value : {1e18, -1.0, 1.0, 0.5, std::nan("")})
    changes.push_back({"load_steps", [value](RawCheckpoint& c) { c.set("load_steps_over", value); }});
  for (const double value : {-1.0, 1e300, std::nan("")})
    changes.push_back(
        {"\"outer_iterations\"", [value](RawCheckpoint& c) { c.set("outer_iterations", value); }});
  changes.push_back({"\"displacement\"", [](RawCheckpoint& c) { c.fields["displacement"][3] = NAN; }});
  changes.push_back({"no number", [](RawCheckpoint& c) { c.header["numbers"].erase("penalty_normal"); }});
  for (const char* key : {"numbers", "fields", "problem", "case", "load_steps"})
    changes.push_back(
        {"its header has not what is expected", [key](RawCheckpoint& c) { c.header.erase(key); }});
  for (const char* key : {"numbers", "fields", "problem"})
    changes.push_back({"its header has not what is expected", [key](RawCheckpoint& c) {
                         c.header[key] = {1, "x"};
                       }});
  nlohmann::json deep = 1;
  for (int level = 0; level < 300; ++level) deep = nlohmann::json::array({deep});
  changes.push_back({"64 levels", [&deep](RawCheckpoint& c) { c.header["case"] = deep; }});
  changes.push_back({"no JSON object", [](RawCheckpoint& c) { c.header = 7; }});
  for (const Change& change : changes) {
    INFO(change.words, ", change ", &change - changes.data());
    place.put("out/checkpoint.kacanov", whole);
    change_checkpoint(file, change.make);
    const Outcome outcome = place.run("run beam.json --output out --restart");
    INFO(outcome.error);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.error.find("checkpoint.kacanov") != std::string::npos);
    CHECK(outcome.error.find(change.words) != std::string::npos);
  }
  place.put("out/checkpoint.kacanov", whole);
  change_checkpoint(file, [](RawCheckpoint&) {});
  CHECK(place.run("run beam.json --output out --restart").exit_code == 0);
}

TEST_CASE("a boundary whose arrays do not fit each other is refused by the name of the array") {
  std::vector<std::int32_t> nodes;
  Part part;
  const Problem right = small_boundary(nodes, part);
  CHECK_NOTHROW(check_boundary(right, nodes, part));
  using Change = std::pair<const char*, std::function<void(Problem&)>>;
  for (const Change& each : {
           Change{"element type", [](Problem& p) { p.mesh.type = ElementType::quad4; }},
           Change{"coordinates", [](Problem& p) { p.mesh.coordinates.pop_back(); }},
           Change{"coordinates", [](Problem& p) { p.mesh.coordinates[1] = NAN; }},
           Change{"node numbers", [](Problem& p) { p.mesh.node_tags.assign(3, 1); }},
           Change{"facets", [](Problem& p) { p.mesh.facets.pop_back(); }},
           Change{"facets", [](Problem& p) { p.mesh.facets[2] = 1 << 30; }},
           Change{"facets", [](Problem& p) { p.mesh.facets[0] = -1; }},
           Change{"elements", [](Problem& p) { p.mesh.elements[0] = 4; }},
           Change{"element numbers", [](Problem& p) { p.mesh.element_tags.assign(1, 1); }},
           Change{"elements of facets", [](Problem& p) { p.mesh.facet_element[0] = 2; }},
           Change{"groups", [](Problem& p) { p.mesh.groups[0].dimension = 3; }},
           Change{"groups", [](Problem& p) { p.mesh.groups[0].members[0] = 77; }},
           Change{"nodes",
                  [](Problem& p) {
                    p.mesh.coordinates.resize(6);
                    p.mesh.facets.clear();
                    p.mesh.facet_element.clear();
                    p.mesh.elements.clear();
                    p.mesh.groups.clear();
                  }},
       }) {
    INFO(each.first);
    Problem problem = right;
    each.second(problem);
    CHECK_THROWS_WITH_AS(check_boundary(problem, nodes, part), doctest::Contains(each.first), InputError);
  }
  part.total_contact += 1;
  CHECK_THROWS_WITH_AS(check_boundary(right, nodes, part), doctest::Contains("contact points"), InputError);
  nodes[0] = -3;
  CHECK_THROWS_WITH_AS(check_boundary(right, nodes, part), doctest::Contains("nodes name -3"), InputError);
}
