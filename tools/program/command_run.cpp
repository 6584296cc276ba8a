// SPDX-License-Identifier: BSD-3-Clause
// kacanov run: solves a case and writes all results.
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string_view>

#include <kacanov/discretisation.hpp>
#include <kacanov/element_fields.hpp>
#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"
#include "formats/mesh_file.hpp"
#include "formats/mesh_writer.hpp"
#include "formats/printable.hpp"
#include "mesh/classic_locale_stream.hpp"
#include "program/adaptive_run.hpp"
#include "program/checkpoint_file.hpp"
#include "program/coarse_run.hpp"
#include "program/commands.hpp"
#include "program/field_files.hpp"
#include "program/history.hpp"
#include "program/interrupt.hpp"
#include "program/launch.hpp"
#include "program/loaded_case.hpp"
#include "program/memory_model.hpp"
#include "program/output_folder.hpp"
#include "program/part_files.hpp"
#include "program/report.hpp"
#include "program/report_page.hpp"
#include "program/result_json.hpp"
#include "program/show_run.hpp"
#include "program/solve_case.hpp"
#include "program/terminal.hpp"

namespace kacanov {
namespace {

/// File in the output folder with the mesh of mesh.adapt.
constexpr const char* adapted_mesh_file = "mesh.msh";

/// Returns whether a run writes files of this name, complete or unfinished. A complete checkpoint is
/// excluded: it stays.
bool is_output(std::string_view name) {
  const std::string_view whole = without_number(name, ".part");
  if (whole == "checkpoint.kacanov") return whole != name;
  for (const std::string_view file :
       {"result.json", "summary.txt", "history.csv", "deformed.svg", "report.html", adapted_mesh_file})
    if (whole == file) return true;
  return is_field_file(whole);
}

/// Removes files of an earlier run that this one may not overwrite, and unfinished ones of a killed run. With
/// `goes_on`, a restart, fields of earlier load steps are kept.
void clear_folder(const std::filesystem::path& folder, bool goes_on) {
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!is_output(name) || (goes_on && (is_step_file(name) || name == adapted_mesh_file))) continue;
    if (std::filesystem::is_directory(entry.symlink_status()))
      throw InputError("--output: " + entry.path().string() +
                       " stands where a file of the run belongs, and is a folder: move it away");
    old.push_back(entry.path());
  }
  for (const std::filesystem::path& file : old) std::filesystem::remove(file);
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  // A message may quote invalid UTF-8, such as a file name.
  using Handler = nlohmann::ordered_json::error_handler_t;
  write_file(file.string(), json.dump(2, ' ', false, Handler::replace) + "\n");
}

/// Returns the values of some nodes; empty if `nodes` is empty.
std::vector<double> picked(std::span<const double> all, std::span<const std::int32_t> nodes, int components) {
  const std::size_t width = components;
  std::vector<double> some;
  some.reserve(nodes.size() * width);
  for (const std::int32_t n : nodes) {
    const auto values = all.subspan(n * width, width);
    some.insert(some.end(), values.begin(), values.end());
  }
  return some;
}

/// Returns a function that prints the current phase, if the run is long enough; on the first rank.
std::function<void(const std::string&)> tell_phases(const Command& command, const Case& input,
                                                    const Terminal& terminal, double start) {
  constexpr std::int64_t soon = 100'000;  // unknowns; smaller runs take a second or two
  if (command.quiet || (!command.verbose && command.parts.empty() && estimate_unknowns(input.mesh) < soon))
    return {};
  return [terminal, start](const std::string& phase) {
    PlainText line;
    line << '[' << std::fixed << std::setprecision(1) << std::setw(7) << MPI_Wtime() - start << " s] "
         << phase;
    std::cout << coloured(terminal, Colour::grey, line.str()) << std::endl;
  };
}

LoadedCase load(const Command& command, const Case& input, const MpiSession& mpi,
                const std::function<void(const std::string&)>& phase) {
  if (!command.parts.empty()) {
    if (phase && mpi.first()) phase("reading the parts in " + printable(command.parts));
    return load_parts(command.parts, input, mpi);
  }
  LoadedCase loaded = load_case(input, mpi, command.memory_check, phase);
  keep_boundary(loaded);
  return loaded;
}

/// Solves; an error in the checkpoint of a restart is reported with its file name.
Solution solve_from(const Case& input, Part& part, const MpiSession& mpi, const RunOptions& options,
                    const std::string& checkpoint) {
  try {
    return solve_part(input, part, mpi, options);
  } catch (const InputError& error) {
    if (checkpoint.empty()) throw;
    throw InputError("--restart: " + checkpoint + ": " + error.what());
  }
}

std::string checkpoint_line(const CheckpointFile& file) {
  return file.written() ? "  checkpoint    " + printable(file.path().string()) +
                              "; the option --restart goes on from there\n"
                        : "";
}

std::string preset_line(const Case& input) {
  const std::string text = input.preset.text();
  return text.empty() ? text : "  preset        " + printable(text) + "\n";
}

/// Returns a nodal field at the boundary nodes, on the first rank. Collective.
std::vector<double> at_boundary(const LoadedCase& loaded, std::span<const double> local, int components) {
  return picked(gather_nodal(loaded.part, local, components), loaded.boundary_nodes, components);
}

/// Writes the fields of a completed load step. Collective.
void write_step(const FieldPlace& place, const LoadedCase& loaded, const Model& model, const MpiSession& mpi,
                const Solution& solution) {
  ContactFields contact = gather_contact_fields(loaded.part, solution);
  contact.displacement = at_boundary(loaded, solution.displacement, loaded.part.dim());
  Recovered recovered = recover_and_estimate(loaded.part, solution);
  const BodyFields fields{std::move(recovered.nodal), element_numbers(loaded.part, solution),
                          recovered.error.shares(), loaded.sets};
  write_body(place, loaded.part, solution, fields, mpi);
  together(mpi, [&] {
    if (mpi.first()) write_surface(place, *loaded.problem, model, contact);
  });
}

/// A failure after the solve keeps the numbers: adds status and message to the existing result.json.
void note_failure(const std::filesystem::path& folder, const std::string& text) {
  const std::filesystem::path file = folder / "result.json";
  if (!std::filesystem::exists(file)) return write_json(file, failure_json(text));
  PlainFile stream(file);
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(stream);
  json["status"] = "failed";
  json["message"] = text;
  write_json(file, json);
}

/// An error in pictures and texts must not fail a run whose numbers are written.
void try_to_show(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    std::cerr << "kacanov: warning: not shown: " + printable(error.what()) + "\n";
  }
}

/// Adapts the mesh, or reads the adapted mesh of the run to be continued. Collective.
CoarseRun adapt_or_read(const Command& command, Case& input, const MpiSession& mpi,
                        const std::function<void(const std::string&)>& phase) {
  if (!command.parts.empty()) throw InputError("--parts: a mesh that is adapted has none yet (mesh.adapt)");
  if (command.restart) {
    together(mpi, [&] {
      if (!mpi.first()) return;
      const std::string file = (output_folder(command, input) / adapted_mesh_file).string();
      input.mesh.adapted = std::make_shared<const Mesh>(read_mesh(file));
    });
    return {};
  }
  RunOptions options;
  options.stop_requested = interrupt_came;
  options.threads = threads_of(command);
  options.phase = phase;
  if (!command.quiet) options.progress = [](const ProgressStep&) {};
  return adapt(input, mpi, options);
}

}  // namespace

void leave_failure(const Command& command, const Case& input, const std::string& text) {
  const std::filesystem::path folder = output_folder(command, input);
  const OutputFolder held(folder);
  write_json(folder / "result.json", failure_json(text));
}

ResultMark::ResultMark(const Command& command, const Case& input)
    : folder_(output_folder(command, input)), before_(written()) {}

void ResultMark::leave(const std::string& text) const {
  try {
    const OutputFolder held(folder_);
    if (written() == before_) std::filesystem::remove(folder_ / "result.json");
    note_failure(folder_, text);
  } catch (...) {  // the message on standard error must suffice
  }
}

std::filesystem::file_time_type ResultMark::written() const {
  std::error_code none;
  return std::filesystem::last_write_time(folder_ / "result.json", none);
}

int run_command(const Command& command, const Case& given, MpiSession& mpi) {
  const double start = MPI_Wtime();
  const Terminal terminal = terminal_of_output();
  const auto phase = tell_phases(command, given, terminal, start);
  const std::filesystem::path folder = output_folder(command, given);
  listen_for_interrupts(command.stop_within);
  Case input = given;
  CoarseRun coarse;
  if (given.mesh.adapt) coarse = adapt_or_read(command, input, mpi, phase);
  LoadedCase loaded = load(command, input, mpi, phase);
  std::shared_ptr<OutputFolder> held;  // on the first rank, like the following
  std::optional<CheckpointFile> file;
  std::optional<Checkpoint> left;
  together(mpi, [&] {
    if (!mpi.first()) return;
    file.emplace(folder, input, loaded.print);
    if (command.restart) left = file->read();
    held = std::make_shared<OutputFolder>(folder);
    clear_folder(folder, command.restart);
    if (!command.restart) file->remove();
    if (input.mesh.adapted && !command.restart)
      write_gmsh((folder / adapted_mesh_file).string(), *input.mesh.adapted);
    input.mesh.adapted.reset();
  });

  // The output folder is shared by all ranks, and the first one to fail records it there. The session keeps
  // the folder locked until then.
  mpi.when_failing([folder, held](const Failure& failure) { note_failure(folder, failure.text); });

  RunOptions options;
  options.stop_requested = interrupt_came;
  if (mpi.first() && input.output.checkpoint) {
    options.checkpoint_due = [&] { return file->due(); };
    options.checkpoint = [&](const Checkpoint& checkpoint) { file->write(checkpoint); };
  }
  options.threads = threads_of(command);
  options.phase = phase;
  History history;
  ProgressTable table(terminal, input.model.solver.tolerance);
  options.progress = [&](const ProgressStep& step) {
    history.add(step);
    if (!command.quiet) table(step);
  };
  if (!command.quiet) options.stage = [&](const std::string& name) { table.stage(name); };
  // A run that was stopped before its first step starts from the beginning. Later load steps start from the
  // coarser meshes after other restarts too.
  const bool begins = !loaded.part.node_map.any(left && left->begun());
  if (begins) left.reset();
  options.start = left ? &*left : nullptr;
  const bool by_steps = input.model.solver.load_steps.size() > 1 || input.model.steps.size() > 1;
  if (!given.mesh.adapt && (begins || by_steps)) {
    RunOptions before = options;
    if (command.quiet) before.progress = nullptr;
    coarse = solve_coarser(input, loaded.part.dim(), mpi, before);
  }
  options.coarse = coarse.solutions;
  if (input.output.fields && input.output.steps)
    options.load_step_over = [&](const Part&, const Solution& now) {
      write_step({folder, now.result.load_steps.size()}, loaded, input.model, mpi, now);
    };
  Solution solution = solve_from(input, loaded.part, mpi, options, left ? file->path().string() : "");

  const double solved = MPI_Wtime();
  stop_came_in_time();
  coarse.solutions.clear();
  RunFigures figures;
  figures.nested = coarse.levels;
  figures.sets = loaded.set_names;
  figures.peak_memory_bytes =
      static_cast<std::uint64_t>(loaded.part.node_map.sum_all(static_cast<std::int64_t>(peak_memory())));
  left.reset();
  Result& result = solution.result;
  const int dim = loaded.part.dim();
  if (mpi.first()) complete_messages(input, *loaded.problem, result);
  ContactFields contact = gather_contact_fields(loaded.part, solution);
  contact.displacement = at_boundary(loaded, solution.displacement, dim);
  Recovered recovered = recover_and_estimate(loaded.part, solution);
  note_discretisation(recovered.error, coarse, result);
  const BodyFields fields{std::move(recovered.nodal), element_numbers(loaded.part, solution),
                          recovered.error.shares(), loaded.sets};
  result.max_von_mises_nodal = fields.nodal.max_von_mises;
  const std::vector<double>& displacement = contact.displacement;
  std::vector<double> von_mises, plastic;
  if (input.output.report) {
    const NodalMeans means = nodal_means(loaded.part, fields.numbers);
    if (result.plastic_elements > 0) plastic = at_boundary(loaded, means.plastic_share, 1);
    von_mises = at_boundary(loaded, means.von_mises, 1);
  }
  if (phase && mpi.first()) phase("writing to " + printable(folder.string()));
  // Write the numbers first, so that a later failure cannot lose them.
  figures.read = loaded.read_seconds;
  figures.distribute = loaded.distribute_seconds;
  figures.total = solved - start;
  together(mpi, [&] {
    if (mpi.first())
      write_json(folder / "result.json", result_json(result, figures, input, loaded.problem->mesh));
  });
  // Before a checkpoint is removed, the files that replace it are synced to disk.
  const bool replaced = loaded.part.node_map.any(mpi.first() && result.status == Status::converged &&
                                                 std::filesystem::exists(file->path()));
  if (input.output.fields) write_body({folder}, loaded.part, solution, fields, mpi);
  together(mpi, [&] {
    if (!mpi.first()) return;
    if (input.output.fields) {
      write_surface({folder}, *loaded.problem, input.model, contact);
      write_series(folder, *loaded.problem, result);
    }
    ShownRun shown_run;
    if (input.output.report) {
      try_to_show([&] {
        shown_run = show_run(input, *loaded.problem, contact, von_mises, plastic, result.max_von_mises);
        write_file((folder / "deformed.svg").string(), shown_run.picture);
      });
    }
    const double end = MPI_Wtime();
    figures.total = end - start;
    figures.output = end - solved;
    // Again, now that the time for output is known.
    const nlohmann::ordered_json json = result_json(result, figures, input, loaded.problem->mesh);
    write_json(folder / "result.json", json);
    const std::string text = summary(result, figures, input.model, dim) + preset_line(input) +
                             (result.status == Status::converged ? "" : checkpoint_line(*file));
    if (input.output.report)
      try_to_show([&] {
        write_file((folder / "summary.txt").string(), shown(Terminal{}, result.status, text));
        write_file((folder / "history.csv").string(), history.csv());
      });
    if (input.output.report)
      try_to_show([&] {
        const ReportPage page{&input, &json, history.csv(), &loaded.problem->mesh, displacement, &shown_run};
        write_file((folder / "report.html").string(), report_html(page));
      });
    if (replaced) {
      for (const char* name : {"result.json", "body.vtu", "contact.vtu", "result.pvd"})
        if (std::filesystem::exists(folder / name)) sync_file((folder / name).string());
      sync_file(folder.string());
      file->remove();
    }
    if (command.quiet) return;
    const std::string files = "  files         " + printable(folder.string()) + "\n";
    std::cout << "\n" + shown(terminal, result.status, text + files);
  });
  return result.status == Status::converged ? exit_converged : exit_not_converged;
}

}  // namespace kacanov
