// SPDX-License-Identifier: BSD-3-Clause
// Runs the real program in a folder of its own and returns its output.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "temporary_folder.hpp"

namespace kacanov::testing {

struct Outcome {
  int exit_code = -1;
  std::string output, error;  ///< `output` has wrapped lines joined again
  std::string printed;        ///< standard output, unchanged
};

std::string contents(const std::filesystem::path& file);
std::size_t count_lines(const std::string& text);
/// Parses JSON; defined in a source file so that the parser is compiled once.
nlohmann::json parsed(const std::string& text);

/// A temporary folder with case files, in which the program runs.
class Workplace {
 public:
  void put(const std::string& name, const std::string& text) const;
  void put_json(const std::string& name, const nlohmann::json& json) const;
  std::filesystem::path path(const std::string& name) const;
  bool has(const std::string& name) const;
  nlohmann::json json(const std::string& name) const;

  /// Runs "kacanov <arguments>"; words that need it are quoted for the shell. `before` precedes the command.
  Outcome run(const std::string& arguments, const std::string& before = "") const;

 private:
  TemporaryFolder folder_;
};

/// Prefix for scripts and programs that may hang: kills them after 120 s, which the test sees as another exit
/// code.
inline const std::string patience = "timeout -s KILL 120";

/// A coarse version of the paper's beam in 2D: 54 nodes, clamped at its left, resting on a plane.
nlohmann::json small_beam();

}  // namespace kacanov::testing
