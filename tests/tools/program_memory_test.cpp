// SPDX-License-Identifier: BSD-3-Clause
// Cases that `kacanov check` and `run` refuse for lack of memory.
#include <doctest/doctest.h>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

nlohmann::json large_beam() {
  nlohmann::json input = small_beam();
  input["mesh"]["box"] = {{"size", {4, 1, 1}}, {"cells", {2560, 640, 640}}, {"element", "tet4"}};
  input["boundary"] = {{{"on", "left"}, {"displacement", {0, 0, 0}}},
                       {{"on", "top"}, {"traction", {0, 0, -0.01}}}};
  input["contact"][0]["obstacle"]["plane"] = {{"point", {0, 0, 0}}, {"normal", {0, 0, 1}}};
  input.erase("probe");
  return input;
}

}  // namespace

TEST_CASE("what cannot fit is refused before it starts, with both numbers") {
  const Workplace place;
  place.put_json("beam.json", large_beam());
  for (const char* command : {"check", "run"}) {
    const Outcome outcome = place.run(std::string(command) + " beam.json --ranks 1");
    CAPTURE(outcome.error);
    CHECK(outcome.exit_code == 2);
    // About 315 bytes per unknown, 3.15e9 unknowns.
    const std::string before = "this case needs about ";
    const std::size_t at = outcome.error.find(before);
    REQUIRE(at != std::string::npos);
    CHECK(std::stod(outcome.error.substr(at + before.size())) == doctest::Approx(990).epsilon(0.15));
    CHECK(outcome.error.find(" GB of memory on 1 rank") != std::string::npos);
    CHECK(outcome.error.find("are available") != std::string::npos);
    CHECK(count_lines(outcome.error) == 1);
  }
  CHECK_FALSE(place.has("results"));
}
