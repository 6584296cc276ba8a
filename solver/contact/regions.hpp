// SPDX-License-Identifier: BSD-3-Clause
// Regions of similar stiffness, and clusters of regions (theory: regions).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Stress resultant of one region at a node shared by regions: a nodal force with reversed sign.
struct InterfaceForce {
  std::int32_t node = 0, region = 0;
  Vector3 force{};
  Vector3 stiff{};  ///< size of the terms of the force: D of the region times the largest |u| of its elements
                    ///< there
};

/// Temperature at the current load: the thermal pressure of each constrained element, as
/// LoadPath::thermal_pressure() returns it, and the free strain of elements in plane stress.
struct ThermalState {
  std::span<const double> pressure, free_strain;
};

/// A region consists of connected elements whose elastic shear moduli are within a factor of ten. A node
/// belongs to the stiffest region of its elements. The same on all ranks.
class StiffnessRegions {
 public:
  /// Connected regions of at least a given stiffness: relative to softer regions they act as one stiff body.
  struct Cluster {
    std::vector<std::int32_t> regions;
    int bin = 0;  ///< of its softest region
    Vector3 centre{};
    double radius = 0.0;  ///< half diagonal of the box around its nodes
  };

  /// Collective. The part must outlive it.
  explicit StiffnessRegions(const Part& part);
  /// Returns the whole body as one region. Collective.
  static StiffnessRegions whole(const Part& part);

  std::size_t count() const noexcept { return bin_.size(); }
  /// Returns the bin of a region: 0 for the stiffest, one more per factor of ten.
  int bin(std::size_t region) const noexcept { return bin_[region]; }
  std::int32_t of_node(std::size_t node) const noexcept { return of_node_.empty() ? 0 : of_node_[node]; }
  /// One entry per local node; empty if there is one region.
  std::span<const std::int32_t> of_nodes() const noexcept { return of_node_; }
  const std::vector<Cluster>& clusters() const noexcept { return clusters_; }

  /// Returns the forces of every region at owned nodes that it shares with others, ascending by node.
  /// `dilatation`: corner_dilatation() of u. Collective.
  std::vector<InterfaceForce> interface_forces(std::span<const double> u, const ThermalState& thermal,
                                               std::span<const double> dilatation) const;

 private:
  StiffnessRegions() = default;
  /// The elements of one region that have shared nodes, with local node numbers.
  struct Interface {
    std::int32_t region = 0;
    std::vector<std::int32_t> nodes, elements;  ///< of the part
    std::vector<std::int32_t> connectivity;
    std::vector<double> coordinates;
    std::vector<double> diagonal;  ///< of the elastic stiffness of these elements
    std::vector<std::uint16_t> laws;
  };

  void find_interfaces(std::span<const std::int32_t> region_of_element);
  void find_clusters(std::vector<std::array<std::int32_t, 2>> neighbours);

  const Part* part_ = nullptr;
  std::vector<int> bin_;
  std::vector<std::int32_t> of_node_;
  std::vector<std::uint8_t> shared_;  ///< nodes of several regions; empty if there is one region
  std::vector<Cluster> clusters_;
  std::vector<Interface> interfaces_;
};

}  // namespace kacanov
