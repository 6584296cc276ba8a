// SPDX-License-Identifier: BSD-3-Clause
// Reads a Gmsh mesh from a file or its bytes.
#include "formats/gmsh_reader.hpp"

#include <kacanov/error.hpp>
#include "formats/gmsh_parser.hpp"
#include "formats/mapped_file.hpp"
#include "formats/mesh_maker.hpp"

namespace kacanov {
namespace {

MeshContent parse_file(const std::string& path) {
  const MappedFile file(path);
  try {
    MeshContent content = parse_gmsh(path, file.bytes());
    file.check_unchanged();
    return content;
  } catch (const InputError&) {
    file.check_unchanged();  // then that is what is wrong
    throw;
  }
}

}  // namespace

Mesh read_gmsh(const std::string& path) { return make_mesh(path, parse_file(path)); }

Mesh read_gmsh(const std::string& path, std::string_view bytes) {
  return make_mesh(path, parse_gmsh(path, bytes));
}

}  // namespace kacanov
