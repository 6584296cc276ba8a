// SPDX-License-Identifier: BSD-3-Clause
// The small body of the tests of the C interface, with constraints, penalty blocks and a multigrid.
#pragma once

#include "c_example.hpp"

struct DestroyMultigrid {
  void operator()(kacanov_multigrid* multigrid) const { kacanov_multigrid_destroy(multigrid); }
};
using MultigridHandle = std::unique_ptr<kacanov_multigrid, DestroyMultigrid>;

inline MultigridHandle multigrid_of(const Handle& op) {
  kacanov_multigrid* made = nullptr;
  const int code = kacanov_multigrid_create(op.get(), nullptr, &made);
  INFO(kacanov_message(op.get()));
  REQUIRE(code == KACANOV_OK);
  return MultigridHandle(made);
}

/// Returns the unknowns of the nodes at the bottom (lowest z, or y in 2D), which are constrained.
inline std::vector<std::int32_t> bottom(const SmallMesh& mesh) {
  std::vector<std::int32_t> list;
  for (std::size_t i = 0; i < mesh.unknowns(); ++i)
    if (mesh.coordinates[i / mesh.dim * mesh.dim + mesh.dim - 1] < 0.15)
      list.push_back(static_cast<std::int32_t>(i));
  return list;
}

/// Nodes with penalty blocks: a stiff spring in an oblique direction, added twice at one node.
struct Springs {
  std::vector<std::int32_t> node;
  Vector block;
  explicit Springs(const SmallMesh& mesh) {
    const std::size_t last = mesh.nodes() - 1;
    for (const std::size_t n : {last, last - 1, last}) {
      node.push_back(static_cast<std::int32_t>(n));
      for (std::size_t i = 0; i < mesh.dim; ++i)
        for (std::size_t j = 0; j < mesh.dim; ++j)
          block.push_back(3.0 * static_cast<double>(i + 1) * static_cast<double>(j + 1));
    }
  }
};

inline void hold(const Handle& op, const SmallMesh& mesh) {
  const auto list = bottom(mesh);
  const Springs springs(mesh);
  REQUIRE(kacanov_constrain(op.get(), list.size(), list.data()) == KACANOV_OK);
  REQUIRE(kacanov_set_blocks(op.get(), springs.node.size(), springs.node.data(), springs.block.data()) ==
          KACANOV_OK);
}
