// SPDX-License-Identifier: BSD-3-Clause
// Queries the terminal behind standard output, and wraps lines.
#include "program/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {
namespace {

/// "WIDTH COLOUR", set for the ranks that this program starts under mpiexec.
constexpr const char* handed_down = "KACANOV_TERMINAL";
constexpr int narrowest = 40, widest = 400;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// Columns of a text: the number of UTF-8 characters.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

Terminal terminal_of_output() {
  Terminal terminal;
  if (is_set(handed_down)) {
    PlainWords words(std::getenv(handed_down));
    words >> terminal.width >> terminal.colour;
  } else if (isatty(STDOUT_FILENO) != 0) {
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) terminal.width = size.ws_col;
    const char* kind = std::getenv("TERM");
    terminal.colour = !is_set("NO_COLOR") && kind != nullptr && std::string_view(kind) != "dumb";
  }
  terminal.width = std::clamp(terminal.width, narrowest, widest);
  return terminal;
}

void hand_terminal_down() {
  const Terminal terminal = terminal_of_output();
  setenv(handed_down, (std::to_string(terminal.width) + (terminal.colour ? " 1" : " 0")).c_str(), 1);
}

std::string wrapped(std::string_view text, int width, int indent) {
  const auto room = static_cast<std::size_t>(width);
  std::string result;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    std::string_view rest = line;
    std::string start;
    while (columns(start) + columns(rest) > room) {
      // Cut at the last blank after the indentation that leaves a short enough line; if there is none, at the
      // first blank.
      std::size_t cut = std::string_view::npos;
      for (std::size_t at = rest.find(' ', rest.find_first_not_of(' ')); at != std::string_view::npos;
           at = rest.find(' ', at + 1)) {
        if (cut != std::string_view::npos && columns(start) + columns(rest.substr(0, at)) > room) break;
        cut = at;
      }
      if (cut == std::string_view::npos) break;
      result.append(start).append(rest.substr(0, cut)).append("\n");
      rest = rest.substr(std::min(rest.find_first_not_of(' ', cut), rest.size()));
      start.assign(static_cast<std::size_t>(indent), ' ');
    }
    if (!rest.empty() || start.empty()) result.append(start).append(rest).append("\n");
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return result;
}

std::string coloured(const Terminal& terminal, Colour colour, std::string_view text) {
  if (!terminal.colour) return std::string(text);
  return "\033[" + std::to_string(static_cast<int>(colour)) + "m" + std::string(text) + "\033[0m";
}

}  // namespace kacanov
