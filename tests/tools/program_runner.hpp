// SPDX-License-Identifier: BSD-3-Clause
// Runs the real program in a folder of its own and hands back what it said.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "temporary_folder.hpp"

namespace kacanov::testing {

struct Outcome {
  int exit_code = -1;
  std::string output, error;  ///< lines that were broken to fit are whole again in `output`
  std::string printed;        ///< as it came
};

std::string contents(const std::filesystem::path& file);
std::size_t count_lines(const std::string& text);
/// Here, not in the tests: what the parser takes to compile is paid once.
nlohmann::json parsed(const std::string& text);

/// A folder with case files in it, in which the program runs.
class Workplace {
 public:
  void put(const std::string& name, const std::string& text) const;
  void put_json(const std::string& name, const nlohmann::json& json) const;
  std::filesystem::path path(const std::string& name) const;
  bool has(const std::string& name) const;
  nlohmann::json json(const std::string& name) const;

  /// Runs "kacanov <arguments>", the words quoted for a shell where they need it. `before` comes in front.
  Outcome run(const std::string& arguments, const std::string& before = "") const;

 private:
  TemporaryFolder folder_;
};

/// What a script or a program that may hang is started with: then the test ends it and sees another exit
/// code.
inline const std::string patience = "timeout -s KILL 120";

/// The paper's beam, coarse: 54 nodes in a plane, clamped at its left, resting on a plane.
nlohmann::json small_beam();

}  // namespace kacanov::testing
