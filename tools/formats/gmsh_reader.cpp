// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh mesh from a file or its bytes.
#include "formats/gmsh_reader.hpp"

#include <kacanov/error.hpp>
#include "formats/gmsh_parser.hpp"
#include "formats/mapped_file.hpp"
#include "formats/mesh_maker.hpp"

namespace kacanov {
namespace {

MeshContent parse_file(const SourceFile& source) {
  const MappedFile file(source.path);
  try {
    MeshContent content = parse_gmsh(source, file.bytes());
    file.check_unchanged();
    return content;
  } catch (const InputError&) {
    file.check_unchanged();  // a file that changed explains the error
    throw;
  }
}

}  // namespace

Mesh read_gmsh(const SourceFile& source) { return make_mesh(source.path, parse_file(source)); }

Mesh read_gmsh(const SourceFile& name, std::string_view bytes) {
  return make_mesh(name.path, parse_gmsh(name, bytes));
}

}  // namespace kacanov
