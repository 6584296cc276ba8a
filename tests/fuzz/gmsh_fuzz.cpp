// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a Gmsh file: rejected with a message, or a mesh whose indices are all valid.
#include "formats/gmsh_reader.hpp"
#include "read_mesh.hpp"

using namespace kacanov;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_mesh([&] { return read_gmsh("fuzz.msh", fuzz::Bytes(data, size).rest()); });
  return 0;
}
