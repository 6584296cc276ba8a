// SPDX-License-Identifier: BSD-3-Clause
// Width and colour support of the terminal.
#pragma once

#include <string>
#include <string_view>

namespace kacanov {

/// Properties of standard output.
struct Terminal {
  int width = 80;       ///< columns; 80 if it is not a terminal
  bool colour = false;  ///< true only on a terminal without NO_COLOR
};

/// Returns the terminal of this process, or of the one that started it under mpiexec (hand_terminal_down).
Terminal terminal_of_output();
/// Describes the terminal in the environment, for ranks whose output goes through a pipe.
void hand_terminal_down();

/// Wraps lines longer than `width`; continuation lines start with `indent` blanks. Words are never split.
std::string wrapped(std::string_view text, int width, int indent);

/// Wraps the text in an ANSI colour; unchanged if the terminal has no colour.
enum class Colour { green = 32, red = 31, yellow = 33, grey = 90 };
std::string coloured(const Terminal& terminal, Colour colour, std::string_view text);

}  // namespace kacanov
