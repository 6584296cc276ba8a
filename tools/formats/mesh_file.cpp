// SPDX-License-Identifier: BSD-3-Clause
// Reads a mesh of whatever format its file is in.
#include "formats/mesh_file.hpp"

#include <algorithm>

#include <kacanov/error.hpp>
#include "formats/deck.hpp"
#include "formats/gmsh_reader.hpp"
#include "formats/mapped_file.hpp"

namespace kacanov {

MeshFormat format_of(const std::string& path, std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  const auto refuse = [&](const char* what) { throw InputError(path + ": " + what); };
  if (bytes.starts_with('*')) return MeshFormat::deck;
  // Fluent writes its sections as lists in brackets, Mechanical APDL as commands.
  if (bytes.starts_with('('))
    refuse(
        "this is an ANSYS Fluent mesh, not one of Gmsh: export the mesh as Abaqus .inp, or translate it with "
        "meshio");
  if (bytes.starts_with('/') || bytes.starts_with("!"))
    refuse("this seems to be a file of ANSYS Mechanical: export the mesh as Abaqus .inp or as Gmsh .msh");
  return MeshFormat::gmsh;
}

Mesh read_mesh(const std::string& path) {
  const MeshFormat format = [&] {
    const MappedFile file(path);
    return format_of(path, file.bytes());
  }();
  return format == MeshFormat::deck ? mesh_of(read_deck(path)) : read_gmsh(path);
}

Mesh read_mesh(const std::string& name, std::string_view bytes) {
  return format_of(name, bytes) == MeshFormat::deck ? mesh_of(read_deck(name, bytes))
                                                    : read_gmsh(name, bytes);
}

}  // namespace kacanov
