// SPDX-License-Identifier: BSD-3-Clause
// Regions of like stiffness, and the clusters that they form (theory: regions).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// The stresses of one region at a node that regions share: a force on the node, with its sign changed.
struct InterfaceForce {
  std::int32_t node = 0, region = 0;
  Vector3 force{};
};

/// Temperature at the current load: the pressure of each constrained element, as LoadPath::thermal_pressure()
/// returns it, and the free strain of elements in plane stress.
struct ThermalState {
  std::span<const double> pressure, free_strain;
};

/// Connected elements whose elastic shear moduli lie within a factor of ten are a region. A node belongs to
/// the stiffest region of its elements. The same on all ranks.
class StiffnessRegions {
 public:
  /// Connected regions from a stiffness on: what softer ones see as one stiff body.
  struct Cluster {
    std::vector<std::int32_t> regions;
    int bin = 0;  ///< of the softest of them
    Vector3 centre{};
    double radius = 0.0;  ///< of the box around its nodes
  };

  /// Collective. The part has to outlive it.
  explicit StiffnessRegions(const Part& part);
  /// The whole body as one region. Collective.
  static StiffnessRegions whole(const Part& part);

  std::size_t count() const noexcept { return bin_.size(); }
  /// Of a region: 0 for the stiffest, one more for each factor of ten.
  int bin(std::size_t region) const noexcept { return bin_[region]; }
  std::int32_t of_node(std::size_t node) const noexcept { return of_node_.empty() ? 0 : of_node_[node]; }
  /// One a local node; empty where there is one region.
  std::span<const std::int32_t> of_nodes() const noexcept { return of_node_; }
  const std::vector<Cluster>& clusters() const noexcept { return clusters_; }

  /// The forces of every region at owned nodes that it shares with others, ascending by node. `dilatation`:
  /// corner_dilatation() of u. Collective.
  std::vector<InterfaceForce> interface_forces(std::span<const double> u, const ThermalState& thermal,
                                               std::span<const double> dilatation) const;

 private:
  StiffnessRegions() = default;
  /// The elements of one region that have shared nodes, with nodes numbered among themselves.
  struct Interface {
    std::int32_t region = 0;
    std::vector<std::int32_t> nodes, elements;  ///< of the part
    std::vector<std::int32_t> connectivity;
    std::vector<double> coordinates;
    std::vector<std::uint16_t> laws;
  };

  void find_interfaces(std::span<const std::int32_t> region_of_element);
  void find_clusters(std::vector<std::array<std::int32_t, 2>> neighbours);

  const Part* part_ = nullptr;
  std::vector<int> bin_;
  std::vector<std::int32_t> of_node_;
  std::vector<std::uint8_t> shared_;  ///< nodes of several regions; empty where there is one
  std::vector<Cluster> clusters_;
  std::vector<Interface> interfaces_;
};

}  // namespace kacanov
