// SPDX-License-Identifier: BSD-3-Clause
// Manual page, generated from the same commands and options as --help.
#include "program/command_line.hpp"

namespace kacanov {
namespace {

/// Escapes text for groff.
std::string literal(const std::string& text) {
  std::string escaped;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) escaped += "\\&";
    line_begins = c == '\n';
    escaped += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  }
  return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + literal(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + literal(text) + "\\fR"; }

/// Returns "-o, --output DIR", or the name of a positional argument.
std::string heading(const CLI::Option& option) {
  if (option.get_positional()) return italic(option.get_name());
  std::string text;
  for (const std::string& name : option.get_snames()) text += (text.empty() ? "" : ", ") + bold("-" + name);
  for (const std::string& name : option.get_lnames()) text += (text.empty() ? "" : ", ") + bold("--" + name);
  return option.get_expected_max() == 0 ? text : text + " " + italic(option.get_type_name());
}

std::string tagged(const std::string& heading, const std::string& text) {
  return ".TP\n" + heading + "\n" + literal(text) + "\n";
}

std::string list_of(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : options_of(app))
    if (option->get_name() != "--help") text += tagged(heading(*option), option->get_description());
  return text;
}

template <std::size_t count>
std::string list_of(const Meaning (&meanings)[count]) {
  std::string text;
  for (const auto& [word, meaning] : meanings) text += tagged(bold(word), meaning);
  return text;
}

std::string section_of(const CLI::App& command) {
  std::string usage = command.get_name();
  for (const CLI::Option* option : options_of(command))
    if (option->get_positional())
      usage += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
  return ".SS \"" + literal(usage) + "\"\n" + literal(command.get_description()) + "\n" + list_of(command);
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string text = ".TH KACANOV 1 \"\" \"kacanov " KACANOV_VERSION "\" \"User Commands\"\n";
  text += ".SH NAME\nkacanov \\- " + literal(what_it_does) + "\n";
  text += ".SH SYNOPSIS\n" + bold("kacanov") + " " + italic("COMMAND") + " [" + italic("ARGUMENT") + "...]\n";
  text += ".SH DESCRIPTION\nWhat is to be solved is said in a case file, whose keys " +
          bold("kacanov schema") + " describes.\n" + literal(about_processes) + "\n";
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) text += section_of(*command);
  text += ".SH OPTIONS\n" + tagged(bold("--help"), "print what there is; of a command: its options") +
          list_of(app);
  text += ".SH \"EXIT STATUS\"\n" + list_of(exit_codes);
  text += ".SH ENVIRONMENT\n" + list_of(environment);
  return text;
}

}  // namespace kacanov
