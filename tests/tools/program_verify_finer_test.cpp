// SPDX-License-Identifier: BSD-3-Clause
// Cases whose mesh the program refines or makes quadratic: verified from the coarse file.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "turned_body.hpp"
#include "verified_run.hpp"

using namespace kacanov;
using namespace kacanov::testing;
using nlohmann::json;

namespace {

/// A curved, heated brick on a sphere, also fixed at its lower left edge by groups of nodes.
json brick_to_refine(std::size_t dim) {
  json brick = parsed(R"({
    "mesh": {"file": "body.msh"}, "material": [{"on": "all", "young": 200, "poisson": 0.3, "expansion": 1e-5}],
    "boundary": [{"on": "left"}, {"on": "top", "pressure": 0.3},
                 {"on": "all", "temperature": {"file": "warm.csv", "otherwise": 3}}],
    "contact": [{"on": "bottom", "friction": {"coulomb": 0.2}}], "output": {"report": false}})");
  const bool flat = dim == 2;
  brick["boundary"][0]["displacement"] = flat ? json{0, 0} : json{0, 0, 0};
  brick["contact"][0]["obstacle"]["sphere"] = {{"centre", flat ? json{1, -4} : json{1, 0.5, -4}},
                                               {"radius", 4}};
  return brick;
}

}  // namespace

TEST_CASE("a mesh that is refined or raised is verified from the coarse file, of every element") {
  const Workplace place;
  place.put("warm.csv", "1, 10\n2, -20\n5, 7\n6, 30\n");
  for (const ElementType type :
       {ElementType::tri3, ElementType::quad4, ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(cell(type).name);
    const bool flat = dimension(type) == 2;
    put_mesh(place, {{2, 1, flat ? 0.0 : 0.5}, {3, 2, flat ? 0 : 1}, type}, [](const Point& x) {
      return Point{x[0] + 0.05 * std::sin(3 * x[1]), x[1] + 0.04 * x[0] * x[2], x[2] + 0.03 * x[0] * x[1]};
    });
    json input = brick_to_refine(static_cast<std::size_t>(dimension(type)));
    for (const char* finer :
         {R"({"refine": 1})", R"({"refine": 2})", R"({"order": 2})", R"({"refine": 1, "order": 2})"}) {
      CAPTURE(finer);
      json& mesh = input["mesh"] = parsed(R"({"file": "body.msh"})");
      mesh.update(parsed(finer));
      if (mesh.contains("order") && type != ElementType::tet4) continue;
      if (mesh.value("refine", 0) == 2 && !flat) continue;
      const json result = solved(place, input, flat ? "1" : "2");
      CHECK(result["active_nodes"] > 0);
    }
  }
}

TEST_CASE("a file of temperatures of a mesh that has been adapted cannot be verified, and that is said") {
  const Workplace place;
  place.put("warm.csv", "1, 10\n2, -20\n");
  put_mesh(place, {{2, 1, 0}, {3, 2, 0}, ElementType::tri3}, [](const Point& x) { return x; });
  json input = brick_to_refine(2);
  input["boundary"][2]["temperature"].erase("otherwise");
  input["boundary"][2]["on"] = parsed(R"({"box": [[0, 0], [2, 1]]})");
  std::string all;
  for (int node = 1; node <= 12; ++node) all += std::to_string(node) + ", 5\n";
  place.put("warm.csv", all);
  input["mesh"]["adapt"]["error"] = 0.2;
  place.put_json("case.json", input);
  REQUIRE(place.run("run case.json --output out").exit_code == 0);
  const Outcome verified = place.run("verify case.json --output out");
  CHECK(verified.exit_code == 2);
  CAPTURE(verified.error);
  CHECK(verified.error.find("the file of temperatures does not have node") != std::string::npos);
}
