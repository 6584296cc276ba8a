// SPDX-License-Identifier: BSD-3-Clause
// Reads a mesh file of any supported format.
#include "formats/mesh_file.hpp"

#include <algorithm>

#include <kacanov/error.hpp>
#include "formats/deck.hpp"
#include "formats/gmsh_reader.hpp"
#include "formats/mapped_file.hpp"
#include "formats/text_bytes.hpp"
#include "formats/vtu_reader.hpp"

namespace kacanov {

MeshFormat format_of(const std::string& path, std::string_view bytes) {
  bytes = text_start(path, bytes);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  const auto refuse = [&](const char* what) { throw InputError(path + ": " + what); };
  if (path.ends_with(".geo"))
    refuse("this is a geometry, not yet a mesh: gmsh -3 makes the mesh of it (-2 in the plane), a .msh");
  if (bytes.starts_with('*')) return MeshFormat::deck;
  if (bytes.starts_with('<')) return MeshFormat::vtu;
  // ANSYS Fluent writes sections as parenthesised lists, Mechanical APDL as commands.
  if (bytes.starts_with('('))
    refuse(
        "this is an ANSYS Fluent mesh, not one of Gmsh: export the mesh as Abaqus .inp, or translate it with "
        "meshio");
  if (bytes.starts_with('/') || bytes.starts_with("!"))
    refuse("this seems to be a file of ANSYS Mechanical: export the mesh as Abaqus .inp or as Gmsh .msh");
  return MeshFormat::gmsh;
}

Mesh read_mesh(const SourceFile& source) {
  {
    const MappedFile file(source.path);
    const MeshFormat format = format_of(source.path, file.bytes());
    if (format == MeshFormat::vtu) {
      try {
        Mesh mesh = read_vtu(source, file.bytes());
        file.check_unchanged();
        return mesh;
      } catch (const InputError&) {
        file.check_unchanged();  // a file that changed explains the error
        throw;
      }
    }
    if (format == MeshFormat::gmsh) return read_gmsh(source);
  }
  return mesh_of(read_deck(source));
}

Mesh read_mesh(const SourceFile& name, std::string_view bytes) {
  const MeshFormat format = format_of(name.path, bytes);
  if (format == MeshFormat::vtu) return read_vtu(name, bytes);
  return format == MeshFormat::deck ? mesh_of(read_deck(name, bytes)) : read_gmsh(name, bytes);
}

}  // namespace kacanov
