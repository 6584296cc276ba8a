// SPDX-License-Identifier: BSD-3-Clause
// Parses the command line.
#include "program/command.hpp"

#include <algorithm>

#include "case/case_schema.hpp"
#include "formats/printable.hpp"
#include "mesh/classic_locale_stream.hpp"
#include "problem/input_errors.hpp"
#include "program/command_line.hpp"

namespace kacanov {
namespace {

std::string usage_error(const std::string& what) {
  return "kacanov: error: " + printable(what) + "; kacanov --help says more\n";
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  return names;
}

/// Error message for a first word that is not a command.
std::string no_command(const std::string& word, const std::vector<std::string>& names) {
  const std::string guess = closest_word(word, names);
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return usage_error("there is no command \"" + word + "\"" +
                     (guess.empty() ? "" : " (did you mean \"" + guess + "\"?)") + "; there are: " + list);
}

/// Output of the commands that only print a text; empty for others.
std::string printed(const CLI::App& app) {
  if (app.got_subcommand("schema")) return case_json_schema().dump(2) + "\n";
  if (app.got_subcommand("man")) return manual_page(app);
  if (app.got_subcommand("completion")) return bash_completion(app);
  return {};
}

Command::Kind kind_of(const CLI::App& app) {
  using Kind = Command::Kind;
  constexpr std::pair<const char*, Kind> kinds[] = {
      {"spectrum", Kind::spectrum}, {"sweep", Kind::sweep},
      {"check", Kind::check},       {"partition", Kind::partition},
      {"verify", Kind::verify},     {"convert", Kind::convert},
      {"init", Kind::init}};
  for (const auto& [name, kind] : kinds)
    if (app.got_subcommand(name)) return kind;
  return Kind::run;
}

}  // namespace

ParsedCommand parse_command(int argc, const char* const* argv) {
  Command command;
  const std::unique_ptr<CLI::App> app = make_command_line(command);
  ParsedCommand parsed;
  const std::vector<std::string> names = command_names(*app);
  const std::string first = argc > 1 ? argv[1] : "";
  if (!first.empty() && first[0] != '-' && std::find(names.begin(), names.end(), first) == names.end()) {
    parsed.error = no_command(first, names);
    parsed.exit_code = exit_bad_input;
    return parsed;
  }
  try {
    app->parse(argc, argv);
    if (command.r_min && command.r_max && *command.r_min >= *command.r_max) {
      throw CLI::ValidationError("--r-min", "must be below --r-max");
    }
  } catch (const CLI::ParseError& error) {
    PlainText output, message;
    if (app->exit(error, output, message) == 0) {  // --help and --version end parsing too
      parsed.output = output.str();
      return parsed;
    }
    parsed.error = usage_error(error.what());
    parsed.exit_code = exit_bad_input;
    return parsed;
  }
  parsed.output = printed(*app);
  if (!parsed.output.empty()) return parsed;
  command.kind = kind_of(*app);
  parsed.command = command;
  return parsed;
}

}  // namespace kacanov
