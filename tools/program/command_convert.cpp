// SPDX-License-Identifier: BSD-3-Clause
// kacanov convert: converts a deck to a case and its mesh, or a mesh to another format.
#include <filesystem>
#include <iostream>
#include <numeric>

#include <kacanov/error.hpp>
#include "case/case_file.hpp"
#include "formats/atomic_file.hpp"
#include "formats/deck.hpp"
#include "formats/mapped_file.hpp"
#include "formats/mesh_file.hpp"
#include "formats/mesh_writer.hpp"
#include "formats/printable.hpp"
#include "formats/vtu_writer.hpp"
#include "program/case_text.hpp"
#include "program/commands.hpp"
#include "program/deck_case.hpp"

namespace kacanov {
namespace {

void print_remark(const std::string& remark) { std::cerr << "kacanov: warning: " + printable(remark) + "\n"; }

MeshFormat format_of_file(const std::string& path) {
  const MappedFile file(path);
  return format_of(path, file.bytes());
}

void write_mesh_as_vtu(const std::string& path, const Mesh& mesh) {
  std::vector<std::int64_t> nodes(mesh.node_count()), elements(mesh.element_count());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = mesh.node_tag(i);
  for (std::size_t e = 0; e < elements.size(); ++e) elements[e] = mesh.element_tag(e);
  Grid grid{mesh.dim(), &cell(mesh.type), mesh.coordinates, mesh.elements, {}, {}};
  grid.point_fields.push_back({"node_id", 1, Values<std::int64_t>(nodes)});
  grid.cell_fields.push_back({"element_id", 1, Values<std::int64_t>(elements)});
  write_vtu(path, grid);
}

/// Lists the groups of a mesh in a sentence.
std::string groups_text(const Mesh& mesh) {
  std::string text;
  for (const Group& group : mesh.groups) text += (text.empty() ? "" : ", ") + group.name;
  return text.empty() ? "no groups" : "groups " + text;
}

void say_what_was_written(const std::string& path, const Mesh& mesh) {
  std::cout << printable(path + ": " + std::to_string(mesh.element_count()) + " " +
                         std::string(cell(mesh.type).name) + " elements, " +
                         std::to_string(mesh.node_count()) + " nodes, " + groups_text(mesh)) +
                   "\n";
}

void convert_mesh(const Command& command, const std::string& kind) {
  const Mesh mesh = read_mesh(command.from);
  check_mesh(mesh);
  for (const std::string& warning : mesh.warnings) print_remark(warning);
  if (kind == ".msh")
    write_gmsh(command.to, mesh);
  else if (kind == ".inp")
    write_deck(command.to, mesh);
  else
    write_mesh_as_vtu(command.to, mesh);
  say_what_was_written(command.to, mesh);
}

/// A case converted from a deck, and the paths of its files.
struct MadeCase {
  DeckCase made;
  std::filesystem::path to, mesh, temperatures;
  std::string text;
};

MadeCase case_of_deck(const Command& command, const std::filesystem::path& to) {
  if (format_of_file(command.from) != MeshFormat::deck)
    throw InputError(
        command.from +
        ": expected an Abaqus or CalculiX deck to make a case of; kacanov init writes one for a mesh");
  MadeCase result{{}, to, to, to, {}};
  result.mesh.replace_extension(".msh");
  result.temperatures.replace_extension(".temperature.csv");
  for (const std::filesystem::path& path : {to, result.mesh}) refuse_existing(path.string(), command.force);
  DeckCase& made = result.made = case_of(read_deck(command.from), command.leave_out);
  check_mesh(made.mesh);
  if (!made.temperatures.empty()) {
    refuse_existing(result.temperatures.string(), command.force);
    made.document["boundary"].push_back(
        {{"on", "all"}, {"temperature", {{"file", result.temperatures.filename().string()}}}});
  }
  made.document["mesh"] = {{"file", result.mesh.filename().string()}};
  try {  // the converted keywords must form a valid case
    const Case input = parse_case(nlohmann::json(made.document), to.parent_path().string());
    for (const std::string& warning : input.warnings) made.remarks.push_back(made.with_line(warning));
  } catch (const InputError& error) {
    const std::string message = made.with_line(error.what());
    throw InputError(message != error.what()
                         ? message
                         : command.from + ": the case that the deck comes to cannot be: " + message);
  }
  std::vector<std::string> comments{"Made by kacanov convert of " + command.from + "."};
  comments.insert(comments.end(), made.remarks.begin(), made.remarks.end());
  result.text = case_text(made.document, comments);
  return result;
}

/// Writes all files; if one cannot be written, removes those that did not exist before.
void write_case(const MadeCase& result) {
  std::vector<std::filesystem::path> written;
  const auto write = [&](const std::filesystem::path& path, const auto& writer) {
    const bool is_new = !std::filesystem::exists(path);
    writer(path.string());
    if (is_new) written.push_back(path);
  };
  try {
    write(result.mesh, [&](const std::string& path) { write_gmsh(path, result.made.mesh); });
    if (!result.made.temperatures.empty())
      write(result.temperatures,
            [&](const std::string& path) { write_file(path, result.made.temperatures); });
    write(result.to, [&](const std::string& path) { write_file(path, result.text); });
  } catch (...) {
    std::error_code ignored;
    for (const std::filesystem::path& path : written) std::filesystem::remove(path, ignored);
    throw;
  }
}

void print_case(const Command& command, const MadeCase& result) {
  for (const std::string& remark : result.made.remarks) print_remark(remark);
  if (!command.quiet) say_what_was_written(result.mesh.string(), result.made.mesh);
}

}  // namespace

bool names_deck(const std::string& path) {
  const std::string kind = std::filesystem::path(path).extension().string();
  return kind == ".inp" || kind == ".INP";
}

Command with_case_of_deck(Command command) {
  const std::filesystem::path deck = command.case_file, name = deck.stem();
  if (command.output.empty()) command.output = (std::filesystem::path("results") / name).string();
  const std::filesystem::path folder = command.output, to = folder / (name.string() + ".json");
  if (name == "result" || name == "mesh")
    throw InputError(command.case_file + ": its case would have the name of another file of the run: " +
                     "expected another name, or a case that kacanov convert makes");
  Command convert = command;
  convert.from = command.case_file;
  convert.force = true;  // overwrite the files of an earlier run of the deck
  const MadeCase made = case_of_deck(convert, to);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("--output: the folder " + folder.string() + " cannot be made: " + error.message());
  write_case(made);
  print_case(convert, made);
  if (!command.quiet) std::cout << printable(to.string()) + ": the case that the deck comes to\n";
  command.case_file = to.string();
  return command;
}

int convert_command(const Command& command) {
  const std::filesystem::path from = command.from;
  const std::filesystem::path to = command.to.empty() ? std::filesystem::path(from.stem().string() + ".json")
                                                      : std::filesystem::path(command.to);
  const std::string kind = to.extension().string();
  if (kind == ".json") {
    const MadeCase made = case_of_deck(command, to);
    write_case(made);
    print_case(command, made);
    std::cout << printable(to.string()) +
                     ": the case; kacanov check shows what its entries select, kacanov run solves it\n";
  } else if (kind == ".msh" || kind == ".inp" || kind == ".vtu") {
    refuse_existing(to.string(), command.force);
    convert_mesh(command, kind);
  } else {
    throw InputError(to.string() + ": expected a name that ends with .json, .msh, .inp or .vtu");
  }
  return exit_converged;
}

}  // namespace kacanov
