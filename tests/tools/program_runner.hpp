// SPDX-License-Identifier: BSD-3-Clause
// Runs the real program in a folder of its own and hands back what it said.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "temporary_folder.hpp"

namespace kacanov::testing {

struct Outcome {
  int exit_code = -1;
  std::string output, error;
};

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// A folder with case files in it, in which the program runs.
class Workplace {
 public:
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  void put_json(const std::string& name, const nlohmann::json& json) const { put(name, json.dump()); }
  std::filesystem::path path(const std::string& name) const {
    return std::filesystem::path(folder_.file(name));
  }
  bool has(const std::string& name) const { return std::filesystem::exists(path(name)); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(contents(path(name))); }

  /// Runs "kacanov <arguments>", the words quoted for a shell where they need it. `before` comes in front.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + path("").string() + "' && " + before + " '" KACANOV_PROGRAM "' " +
                                arguments + " >output.txt 2>error.txt </dev/null";
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(path("output.txt")),
                    contents(path("error.txt"))};
    std::filesystem::remove(path("output.txt"));
    std::filesystem::remove(path("error.txt"));
    return outcome;
  }

 private:
  TemporaryFolder folder_;
};

/// The paper's beam, coarse: 54 nodes in a plane, clamped at its left, resting on a plane.
inline nlohmann::json small_beam() {
  return nlohmann::json::parse(R"({
    "mesh": {"box": {"size": [4, 1], "cells": [16, 4], "element": "tri3"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": {"type": "logarithmic", "x0": 0.01}}],
    "boundary": [{"on": "left", "displacement": [0, 0]},
                 {"on": {"box": [[2, 1], [4, 1]]}, "traction": [0, -0.05]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}},
                 "friction": {"tresca": 0.01}}],
    "probe": [[4, 1], [4, 0]]
  })");
}

}  // namespace kacanov::testing
