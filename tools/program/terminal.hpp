// SPDX-License-Identifier: BSD-3-Clause
// How wide what a run prints may be, and whether in colour.
#pragma once

#include <string>
#include <string_view>

namespace kacanov {

/// What the standard output goes to.
struct Terminal {
  int width = 80;       ///< columns; 80 where it is no terminal
  bool colour = false;  ///< on a terminal without NO_COLOR only
};

/// That of this process, or of the one that started it under mpiexec (hand_terminal_down).
Terminal terminal_of_output();
/// Leaves word of the terminal in the environment, for ranks whose output goes through a pipe.
void hand_terminal_down();

/// Lines longer than `width` go on below, behind `indent` blanks; words stay whole, whatever their length.
std::string wrapped(std::string_view text, int width, int indent);

/// An attribute of ANSI terminals round a text; the text alone without colour.
enum class Colour { green = 32, red = 31, yellow = 33, grey = 90 };
std::string coloured(const Terminal& terminal, Colour colour, std::string_view text);

}  // namespace kacanov
