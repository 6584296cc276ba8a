// SPDX-License-Identifier: BSD-3-Clause
// Runs the real program in a folder of its own and returns its output.
#include "program_runner.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace kacanov::testing {

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

namespace {

std::string unwrapped(std::string text) {
  const std::string broken = "\n" + std::string(16, ' ');
  for (std::size_t at = 0; (at = text.find(broken, at)) != std::string::npos;)
    text.replace(at, broken.size(), " ");
  return text;
}

}  // namespace

nlohmann::json parsed(const std::string& text) { return nlohmann::json::parse(text); }

void Workplace::put(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

void Workplace::put_json(const std::string& name, const nlohmann::json& json) const {
  put(name, json.dump());
}

std::filesystem::path Workplace::path(const std::string& name) const { return folder_.file(name); }

bool Workplace::has(const std::string& name) const { return std::filesystem::exists(path(name)); }

nlohmann::json Workplace::json(const std::string& name) const { return parsed(contents(path(name))); }

Outcome Workplace::run(const std::string& arguments, const std::string& before) const {
  // The program itself keeps Open MPI's files of each run apart.
  const std::string command = "unset OMPI_MCA_orte_tmpdir_base; cd '" + path("").string() + "' && " + before +
                              " '" KACANOV_PROGRAM "' " + arguments + " >output.txt 2>error.txt </dev/null";
  const int status = std::system(command.c_str());
  const std::string printed = contents(path("output.txt"));
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, unwrapped(printed),
                  contents(path("error.txt")), printed};
  std::filesystem::remove(path("output.txt"));
  std::filesystem::remove(path("error.txt"));
  return outcome;
}

nlohmann::json small_beam() {
  return parsed(R"({
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
