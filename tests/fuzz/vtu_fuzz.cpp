// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a VTK file of a grid: rejected with a message, or a mesh whose indices are all valid.
#include <algorithm>

#include <kacanov/error.hpp>
#include "bytes.hpp"
#include "formats/vtu_reader.hpp"

using namespace kacanov;

namespace {

bool within(std::span<const std::int32_t> indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](std::int32_t i) { return i >= 0 && static_cast<std::size_t>(i) < count; });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const Mesh mesh = read_vtu("fuzz.vtu", fuzz::Bytes(data, size).rest());
    const std::size_t nodes = mesh.node_count();
    fuzz::expect(within(mesh.elements, nodes) && within(mesh.facets, nodes) &&
                 within(mesh.facet_element, mesh.element_count()));
    for (const Group& group : mesh.groups)
      fuzz::expect(within(group.members, group.dimension == mesh.dim()       ? mesh.element_count()
                                         : group.dimension == mesh.dim() - 1 ? mesh.facet_count()
                                                                             : nodes));
    check_mesh(mesh);
  } catch (const InputError&) {
  }
  return 0;
}
