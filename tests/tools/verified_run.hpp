// SPDX-License-Identifier: BSD-3-Clause
// Runs a case that must converge and verifies its files with the program's own verifier.
#pragma once

#include <doctest/doctest.h>

#include <string>

#include "program_runner.hpp"

namespace kacanov::testing {

/// Returns the result of a case after checking that it converged and is verified.
inline nlohmann::json solved(const Workplace& place, const nlohmann::json& input,
                             const std::string& ranks = "1") {
  place.put_json("case.json", input);
  const Outcome run = place.run("run case.json --output out --ranks " + ranks);
  INFO(run.error);
  REQUIRE(run.exit_code == 0);
  const Outcome verified = place.run("verify case.json --output out");
  INFO(verified.error, verified.output);
  CHECK(verified.exit_code == 0);
  return place.json("out/result.json");
}

}  // namespace kacanov::testing
