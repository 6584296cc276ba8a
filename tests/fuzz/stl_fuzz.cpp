// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as an STL file: rejected with a message, or a surface whose tree finds the closest point.
#include <cmath>

#include <kacanov/error.hpp>
#include "bytes.hpp"
#include "formats/surface_reader.hpp"

using namespace kacanov;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const TriangleList list = parse_stl("fuzz.stl", fuzz::Bytes(data, size).rest());
    const auto points = static_cast<std::int32_t>(list.points.size());
    for (const Surface::Triangle& triangle : list.triangles)
      for (const std::int32_t corner : triangle) fuzz::expect(corner >= 0 && corner < points);
    const Surface surface(list.points, list.triangles);
    fuzz::expect(surface.size() > 0 && std::isfinite(surface.extent()));
    for (const Vector3& x : {Vector3{}, Vector3{1.0, -0.5, 0.25}, list.points.front()}) {
      const Surface::Closest near = surface.closest(x), truly = surface.closest_of_all(x);
      fuzz::expect(near.point == truly.point && near.border == truly.border);
    }
  } catch (const InputError&) {
  }
  return 0;
}
