// SPDX-License-Identifier: BSD-3-Clause
// Commands and options of the program, each with one line of help.
#include "program/command_line.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "case/preset.hpp"

namespace kacanov {
namespace {

std::string footer() {
  std::string text;
  for (const auto& [code, meaning] : exit_codes)
    text += (text.empty() ? "Exit codes: " : "; ") + std::string(code) + " " + meaning;
  return text + ".\n" + about_processes + "\n";
}

void add_common(CLI::App& app, Command& command) {
  app.add_option("CASE.json", command.case_file, "the case file")->required();
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  app.add_option("--preset", command.preset, "solver.preset of the case: paper, dual or default")
      ->check(CLI::IsMember(names).description(""))
      ->type_name("NAME");
  app.add_option("--set", command.overrides, "change a value of the case: solver.tolerance=1e-8 (repeatable)")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
}

void add_parallel(CLI::App& app, Command& command) {
  app.add_option("--ranks", command.ranks, "MPI processes (default: all cores for large cases)")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N");
  app.add_option("--threads", command.threads, "threads a process (default: 1)")
      ->check(CLI::Range(1, 4096).description(""))
      ->type_name("N");
}

void add_output(CLI::App& app, Command& command) {
  app.add_option("-o,--output", command.output, "folder for all files (default: results/<case name>)")
      ->type_name("DIR");
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option*) { return true; });
}

std::unique_ptr<CLI::App> make_command_line(Command& command) {
  auto app = std::make_unique<CLI::App>(std::string("kacanov: ") + what_it_does, "kacanov");
  app->set_version_flag("--version", "kacanov " KACANOV_VERSION);
  app->footer(footer());
  app->require_subcommand(1);
  CLI::Validator number = CLI::PositiveNumber;
  number.description("");

  CLI::App* run = app->add_subcommand("run", "solve a case; writes result.json, fields and pictures");
  add_common(*run, command);
  run->get_option("CASE.json")
      ->description("the case file; or a deck (.inp), whose case is made in the folder");
  add_output(*run, command);
  run->add_flag("!--no-memory-check", command.memory_check,
                "run even where the memory does not seem to be enough");
  run->add_flag("--restart", command.restart,
                "go on from the checkpoint that an unfinished run left in the folder");
  run->add_option("--parts", command.parts, "folder that kacanov partition has written; the mesh is not read")
      ->type_name("DIR");
  run->add_option("--stop-within", command.stop_within,
                  "seconds that a run which was asked to stop may take to begin its output (default: 30)")
      ->check(CLI::Range(0.1, 1e6).description(""))
      ->type_name("SECONDS");
  run->add_flag("--leave-out", command.leave_out, "of a deck: as of convert");
  CLI::Option* quiet = run->add_flag("-q,--quiet", command.quiet, "print nothing but warnings and errors");
  run->add_flag("-v,--verbose", command.verbose, "print what the run is at, however small it is")
      ->excludes(quiet);
  add_parallel(*run, command);

  CLI::App* spectrum =
      app->add_subcommand("spectrum", "lambda_min, lambda_max and r* of the elastic body; no contact solve");
  add_common(*spectrum, command);
  spectrum->add_option("--tolerance", command.tolerance, "relative, on both eigenvalues (default: 1e-2)")
      ->check(CLI::Range(1e-14, 0.5).description(""))
      ->type_name("TOL");
  spectrum->add_flag("--json", command.json, "print JSON instead of a table");
  add_parallel(*spectrum, command);

  CLI::App* sweep = app->add_subcommand(
      "sweep", "iterations and time against fixed penalties r; writes a table and a picture");
  add_common(*sweep, command);
  sweep->add_option("--r-min", command.r_min, "smallest r (default: r*/10)")->check(number)->type_name("R");
  sweep->add_option("--r-max", command.r_max, "largest r (default: 100 r*)")->check(number)->type_name("R");
  sweep->add_option("--points", command.points, "values of r, evenly spaced in log r (default: 21)")
      ->check(CLI::Range(2, 10000).description(""))
      ->type_name("N");
  add_output(*sweep, command);
  add_parallel(*sweep, command);

  CLI::App* check =
      app->add_subcommand("check", "validate a case, show what it selects, estimate memory and time");
  add_common(*check, command);
  check
      ->add_option("--ranks", command.ranks,
                   "estimate for this many processes (default: what run would take)")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N");

  CLI::App* partition = app->add_subcommand(
      "partition", "split a case once into parts that the ranks of later runs read on their own");
  add_common(*partition, command);
  partition->add_option("--ranks", command.ranks, "number of parts, one for each MPI process of the runs")
      ->check(CLI::Range(1, 65535).description(""))
      ->type_name("N")
      ->required();
  partition->add_option("-o,--output", command.output, "folder for the parts")->type_name("DIR")->required();

  CLI::App* verify = app->add_subcommand(
      "verify", "recompute the certificate of a run from its files alone, by an assembly of its own");
  add_common(*verify, command);
  verify->add_option("-o,--output", command.output, "folder of the run (default: results/<case name>)")
      ->type_name("DIR");

  CLI::App* convert = app->add_subcommand(
      "convert", "make a case and its mesh of an Abaqus or CalculiX deck, or another format of a mesh");
  convert->add_option("FROM", command.from, "a deck (.inp) or a mesh")->required();
  convert->add_option(
      "TO", command.to,
      "a case (.json, its mesh beside it) or a mesh (.msh, .inp, .vtu); default: FROM's name .json");
  convert->add_flag("--leave-out", command.leave_out,
                    "leave out keywords that change the answer and are not known, and name them");
  convert->add_flag("--force", command.force, "write over files that are there");

  CLI::App* init = app->add_subcommand("init", "write a case to start from for a mesh, with its groups");
  init->add_option("MESH", command.from, "the mesh")->required();
  init->add_option("CASE.json", command.to, "the case (default: the mesh's name .json)");
  init->add_flag("--force", command.force, "write over a file that is there");

  app->add_subcommand("schema", "print the JSON schema of case files, for editors");
  app->add_subcommand("man", "print the manual page");
  app->add_subcommand("completion", "print what makes bash complete commands, options and keys of --set");
  return app;
}

}  // namespace kacanov
