// SPDX-License-Identifier: BSD-3-Clause
// Nodal fields given as numbers, and their interpolation to refined meshes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <kacanov/refine.hpp>
#include "problem/vector3.hpp"

using namespace kacanov;

TEST_CASE("numbers at nodes are taken over: what is linear stays so") {
  const auto field = [](const Vector3& x) { return 3.0 + x[0] - 2.0 * x[1] + 5.0 * x[2]; };
  const auto is_linear = [&](const Mesh& mesh) {
    REQUIRE(mesh.node_fields.size() == 1);
    REQUIRE(mesh.node_fields[0].values.size() == mesh.node_count());
    double off = 0.0;
    for (std::size_t n = 0; n < mesh.node_count(); ++n)
      off = std::max(
          off, std::abs(mesh.node_fields[0].values[n] - field(position(mesh, static_cast<std::int32_t>(n)))));
    CHECK(off < 1e-13);
  };
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    Mesh mesh = make_box({{2, 1, 1.5}, {2, 2, 2}, type});
    NodeField& values = mesh.node_fields.emplace_back();
    for (std::size_t n = 0; n < mesh.node_count(); ++n)
      values.values.push_back(field(position(mesh, static_cast<std::int32_t>(n))));
    is_linear(refine(refine(mesh)));
    if (can_bisect(type)) is_linear(bisect(bisect(mesh, std::array{0, 3}), std::array{1, 2}));
    if (type == ElementType::tet4) is_linear(raise_order(mesh));
  }
}
