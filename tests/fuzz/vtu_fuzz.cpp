// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a VTK file of a grid: rejected with a message, or a mesh whose indices are all valid.
#include "formats/vtu_reader.hpp"
#include "read_mesh.hpp"

using namespace kacanov;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_mesh([&] { return read_vtu("fuzz.vtu", fuzz::Bytes(data, size).rest()); });
  return 0;
}
