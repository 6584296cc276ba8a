// SPDX-License-Identifier: BSD-3-Clause
// Bash completion, generated from the same commands and options as --help.
#include "case/case_schema.hpp"
#include "case/preset.hpp"
#include "program/command_line.hpp"

namespace kacanov {
namespace {

constexpr const char* script_head = R"(# bash completion of kacanov, by `kacanov completion`
_kacanov() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command='' word words='' files=''
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD - 1}"; do
    if [[ $word != -* ]]; then
      command=$word
      break
    fi
  done
)";

constexpr const char* script_tail = R"(  if [[ -z $command || $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  elif [[ -n $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current"; compgen -f -X "!$files" -- "$current")
  fi
}
complete -F _kacanov kacanov
)";

void add_word(std::string& list, const std::string& word, const char* between = " ") {
  list += (list.empty() ? "" : between) + word;
}

/// Adds "-o" and "--output".
void add_names(std::string& list, const CLI::Option& option, const char* between = " ") {
  for (const std::string& name : option.get_snames()) add_word(list, "-" + name, between);
  for (const std::string& name : option.get_lnames()) add_word(list, "--" + name, between);
}

/// Returns keys at depth one; keys in lists need an index, which depends on the case.
std::string keys_to_set() {
  std::string list;
  for (const Key& part : std::get<KeySet>(case_schema().form().form).keys)
    if (const auto* set = std::get_if<KeySet>(&part.value.form().form))
      for (const Key& key : set->keys) add_word(list, part.name + "." + key.name + "=");
  return list;
}

std::string preset_names() {
  std::string list;
  for (const Preset& preset : presets()) add_word(list, preset.name);
  return list;
}

/// Completes the values of options.
std::string values_of(const CLI::App& app) {
  std::string folders, others;
  for (const CLI::App* command : commands_of(app))
    for (const CLI::Option* option : options_of(*command)) {
      if (option->get_positional() || option->get_expected_max() == 0) continue;
      std::string& list = option->get_type_name() == "DIR" ? folders : others;
      std::string names;
      add_names(names, *option, " | ");
      if (names != "--set" && names != "--preset" && list.find(names) == std::string::npos)
        add_word(list, names, " | ");
    }
  return "  case $previous in\n    " + folders +
         ")\n      compopt -o filenames 2>/dev/null\n"
         "      mapfile -t COMPREPLY < <(compgen -d -- \"$current\")\n      return ;;\n    --set)\n"
         "      compopt -o nospace 2>/dev/null\n      mapfile -t COMPREPLY < <(compgen -W '" +
         keys_to_set() +
         "' -- \"$current\")\n      return ;;\n    --preset)\n      mapfile -t COMPREPLY < <(compgen -W '" +
         preset_names() + "' -- \"$current\")\n      return ;;\n    " + others + ") return ;;\n  esac\n";
}

std::string words_of(const CLI::App& app) {
  std::string first, cases;
  for (const CLI::App* command : commands_of(app)) {
    std::string list, files;
    for (const CLI::Option* option : options_of(*command)) {
      add_names(list, *option);
      if (!option->get_positional() || !files.empty()) continue;
      const std::string name = option->get_name();
      files = name.find('.') == std::string::npos ? "*" : "*" + name.substr(name.find('.'));
    }
    add_word(first, command->get_name());
    cases += "    " + command->get_name() + ") words='" + list + "' files='" + files + "' ;;\n";
  }
  for (const CLI::Option* option : options_of(app)) add_names(first, *option);
  return "  case $command in\n    '') words='" + first + "' ;;\n" + cases + "  esac\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  return script_head + values_of(app) + words_of(app) + script_tail;
}

}  // namespace kacanov
