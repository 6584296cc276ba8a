// SPDX-License-Identifier: BSD-3-Clause
// Terminal output: lines wrapped to the width, colours on request, progress for other programs.
#include "program/terminal.hpp"

#include <doctest/doctest.h>
#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "program/history.hpp"

using namespace kacanov;

namespace {

int longest(const std::string& text) {
  std::istringstream lines(text);
  std::size_t most = 0;
  for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
  return static_cast<int>(most);
}

}  // namespace

TEST_CASE("lines are broken between words and go on behind the indentation") {
  CHECK(wrapped("short\n\nlines\n", 40, 4) == "short\n\nlines\n");
  CHECK(wrapped("  one two three four\n", 10, 4) == "  one two\n    three\n    four\n");
  CHECK(wrapped("no end", 80, 4) == "no end\n");
  const std::string word(50, 'w');
  CHECK(wrapped("a " + word + " b\n", 20, 2) == "a\n  " + word + "\n  b\n");
  std::string text;
  for (int i = 0; i < 300; ++i) text += std::to_string(i * i) + (i % 40 == 39 ? "\n" : " ");
  for (const int width : {40, 57, 80}) CHECK(longest(wrapped(text, width, 16)) <= width);
}

TEST_CASE("a character of several bytes is one column") {
  CHECK(wrapped("\u03bb\u03bb\u03bb \u03bb\u03bb\u03bb\n", 7, 2) ==
        "\u03bb\u03bb\u03bb \u03bb\u03bb\u03bb\n");
}

TEST_CASE("colour is for terminals") {
  CHECK(coloured({80, false}, Colour::red, "no") == "no");
  CHECK(coloured({80, true}, Colour::red, "yes") == "\033[31myes\033[0m");
}

TEST_CASE("ranks take the terminal that they are told of") {
  setenv("KACANOV_TERMINAL", "133 1", 1);
  CHECK(terminal_of_output().width == 133);
  CHECK(terminal_of_output().colour);
  setenv("KACANOV_TERMINAL", "3 0", 1);
  CHECK(terminal_of_output().width == 40);
  CHECK_FALSE(terminal_of_output().colour);
  unsetenv("KACANOV_TERMINAL");
}

TEST_CASE("a history has a line a step, with all digits") {
  History history;
  ProgressStep step;
  step.phase = "newton";
  step.outer = 7;
  step.energy = 0.1;
  history.add(step);
  const std::string text = history.csv();
  CHECK(text.find("\n7,newton,0,0,0,0.10000000000000001,") != std::string::npos);
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  const std::size_t end = text.find('\n');
  CHECK(commas(text.substr(0, end)) == commas(text.substr(end)));
}
