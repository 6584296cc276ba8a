// SPDX-License-Identifier: BSD-3-Clause
// What `kacanov check` says of the memory, against what runs take; and what it refuses.
#include <doctest/doctest.h>

#include <sstream>

#include "program_runner.hpp"

using namespace kacanov::testing;

namespace {

/// Bytes of the memory that `check` expects.
[[maybe_unused]] double estimate(const std::string& output) {
  const std::string key = "  estimate       ";
  const auto at = output.find(key);
  REQUIRE(at != std::string::npos);
  std::istringstream words(output.substr(at + key.size()));
  double value = 0.0;
  std::string unit;
  words >> value >> unit;
  return value * (unit == "GB" ? 1e9 : unit == "MB" ? 1e6 : 0.0);
}

nlohmann::json beam(const std::string& element, const std::vector<int>& cells, bool nonlinear) {
  const std::size_t dim = cells.size();
  nlohmann::json input = small_beam();
  input["mesh"]["box"] = {{"size", dim == 3 ? nlohmann::json{4, 1, 1} : nlohmann::json{4, 1}},
                          {"cells", cells},
                          {"element", element}};
  if (!nonlinear) input["material"][0]["law"] = {{"type", "linear"}};
  if (dim == 3) {
    input["boundary"] = {{{"on", "left"}, {"displacement", {0, 0, 0}}},
                         {{"on", "top"}, {"traction", {0, 0, -0.01}}}};
    input["contact"][0]["obstacle"]["plane"] = {{"point", {0, 0, 0}}, {"normal", {0, 0, 1}}};
    input.erase("probe");
  }
  // Memory does not depend on how far the solution is driven.
  input["solver"] = {{"tolerance", 0.1}};
  input["output"] = {{"fields", "none"}, {"report", false}};
  return input;
}

}  // namespace

#ifndef __SANITIZE_ADDRESS__  // it has its own allocator

TEST_CASE("check foresees the memory of a run within 15 %") {
  const auto compare = [](const nlohmann::json& input, int ranks) {
    const Workplace place;
    place.put_json("beam.json", input);
    const std::string option = " --ranks " + std::to_string(ranks);
    const Outcome check = place.run("check beam.json" + option);
    INFO(check.error);
    REQUIRE(check.exit_code == 0);
    REQUIRE(place.run("run beam.json --output out" + option).exit_code <= 1);
    const double taken = place.json("out/result.json").at("peak_memory_bytes");
    CAPTURE(input["mesh"].dump());
    CAPTURE(ranks);
    CHECK(estimate(check.output) == doctest::Approx(taken).epsilon(0.15));
  };
  compare(beam("tet4", {112, 28, 28}, true), 1);
  compare(beam("tet4", {96, 24, 24}, true), 2);
  compare(beam("hex8", {112, 28, 28}, false), 1);
  compare(beam("tet10", {48, 12, 12}, true), 2);
  compare(beam("tri3", {800, 200}, true), 1);
}

#endif

TEST_CASE("what cannot fit is refused before it starts, with both numbers") {
  const Workplace place;
  place.put_json("beam.json", beam("tet4", {2560, 640, 640}, true));
  for (const char* command : {"check", "run"}) {
    const Outcome outcome = place.run(std::string(command) + " beam.json --ranks 1");
    CAPTURE(outcome.error);
    CHECK(outcome.exit_code == 2);
    // Some 280 bytes an unknown, 3.15e9 of them.
    const std::string before = "this case needs about ";
    const std::size_t at = outcome.error.find(before);
    REQUIRE(at != std::string::npos);
    CHECK(std::stod(outcome.error.substr(at + before.size())) == doctest::Approx(880).epsilon(0.15));
    CHECK(outcome.error.find(" GB of memory on 1 rank") != std::string::npos);
    CHECK(outcome.error.find("are available") != std::string::npos);
    CHECK(count_lines(outcome.error) == 1);
  }
  CHECK_FALSE(place.has("results"));
}
