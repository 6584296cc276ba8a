// SPDX-License-Identifier: BSD-3-Clause
// Supports of nodes for background grids.
#include "multigrid/grid_stiffness.hpp"

#include <Eigen/Dense>

namespace kacanov {
namespace {

/// Stiffness of held directions relative to that of the node: 1 takes 40 instead of 30 iterations with tet4
/// at a million unknowns.
constexpr double held_over_own = 3.0;

using Block = Eigen::Map<Eigen::Matrix3d>;

/// Projector onto the directions held at a node.
Eigen::Matrix3d projector(const HeldDirections& held) {
  Eigen::Matrix3d onto = Eigen::Matrix3d::Zero();
  for (int k = 0; k < held.count; ++k) {
    const auto& b = held.basis[static_cast<std::size_t>(k)];
    const Eigen::Vector3d direction(b[0], b[1], b[2]);
    onto += direction * direction.transpose();
  }
  return onto;
}

}  // namespace

std::vector<NodeBlock> grid_stiffnesses(const FineLevel& fine, std::size_t owned_nodes) {
  std::vector<NodeBlock> all(fine.blocks().begin(), fine.blocks().end());
  std::vector<const HeldDirections*> held_at(owned_nodes, nullptr);
  for (const HeldDirections& held : fine.space().directions)
    if (static_cast<std::size_t>(held.node) < owned_nodes && held.count > 0) held_at[held.node] = &held;
  for (NodeBlock& block : all)
    if (const HeldDirections* held = held_at[block.node]; held != nullptr) {
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - projector(*held);
      Block value(block.value.data());
      value = (across * value * across).eval();
    }
  for (std::size_t n = 0; n < owned_nodes; ++n)
    if (const HeldDirections* held = held_at[n]; held != nullptr) {
      NodeBlock& block = all.emplace_back(NodeBlock{held->node, {}});
      Block(block.value.data()) =
          held_over_own * static_cast<double>(fine.own_stiffness()[n]) * projector(*held);
    }
  const auto held = fine.held();
  for (std::size_t i = 0; i < held.size(); ++i) {
    const std::int32_t node = held[i] / 3, c = held[i] % 3;
    if (static_cast<std::size_t>(node) >= owned_nodes) break;
    NodeBlock& block = all.emplace_back(NodeBlock{node, {}});
    block.value[static_cast<std::size_t>(4 * c)] = static_cast<double>(fine.held_stiffness()[i]);
  }
  return all;
}

}  // namespace kacanov
