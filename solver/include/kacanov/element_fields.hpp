// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of a solution, computed for a range of elements at a time because storing them all would
// dominate a run's memory.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// The data from which stress and strain are computed. Non-owning.
struct BodyState {
  std::span<const double> u;                  ///< nodes × dim
  std::span<const double> thermal;            ///< Solution::thermal, in the units of the part
  std::span<const double> corner_dilatation;  ///< Solution::corner_dilatation, of a part

  BodyState(std::span<const double> displacement) : u(displacement) {}
  BodyState(const std::vector<double>& displacement) : u(displacement) {}
  BodyState(std::span<const double> displacement, std::span<const double> pressure,
            std::span<const double> dilatation = {})
      : u(displacement), thermal(pressure), corner_dilatation(dilatation) {}
  BodyState(const Solution& solution)
      : u(solution.displacement), thermal(solution.thermal), corner_dilatation(solution.corner_dilatation) {}
};

/// Computes fields of elements `first` … `first` + `count` − 1 of the part. Spans of `out` have `count`
/// entries (stress 6 each, xx yy zz xy yz zx), or none if not wanted.
void element_fields(const Part& part, const BodyState& state, std::size_t first, std::size_t count,
                    const reference::ElementFields& out);

/// The same for a complete body.
void element_fields(const Body& body, const BodyState& state, const reference::ElementFields& out);

/// Computes the mean strain of these elements: count × 6 tensor components xx yy zz xy yz zx, thermal strain
/// included.
void element_strains(const Part& part, const BodyState& state, std::size_t first, std::size_t count,
                     std::span<double> out);

/// All fields of a range of consecutive elements.
struct ElementRun {
  std::size_t first = 0;
  std::vector<double> stress, von_mises, dev_strain, secant, strain, rotation, volume;
  std::vector<std::uint8_t> plastic;
};
/// Calls visit(run) for ranges of some thousand elements that cover the whole part.
void visit_element_fields(const Part& part, const BodyState& state,
                          const std::function<void(const ElementRun&)>& visit);

/// Values at the quadrature points of a range of consecutive elements; points of one element are contiguous.
struct PointRun {
  std::size_t first = 0;  ///< first element
  std::vector<Vector3> position;
  std::vector<double> stress;  ///< × 6, as for elements
  std::vector<double> strain;  ///< × 6, tensor components, thermal strain included
  std::vector<double> volume;
};
/// The values that a caller of visit_points() needs; other fields of a run stay empty.
enum class PointValues : std::uint8_t { all, all_but_stress };
/// Calls visit(run) for ranges of some thousand elements that cover the whole part.
void visit_points(const Part& part, const BodyState& state, PointValues wanted,
                  const std::function<void(const PointRun&)>& visit);

/// Scalar fields, one number per element, of all elements of a part: some 33 bytes per element.
struct ElementNumbers {
  std::vector<double> von_mises, dev_strain, secant, volume;
  std::vector<std::uint8_t> plastic;
};
ElementNumbers element_numbers(const Part& part, const BodyState& state);

/// Means at the part's nodes over the elements around each node, on all ranks, weighted by volume.
struct NodalMeans {
  std::vector<double> von_mises;      ///< mean stress
  std::vector<double> plastic_share;  ///< volume fraction that belongs to plastic elements
};
/// Computes nodal means. Collective.
NodalMeans nodal_means(const Part& part, const ElementNumbers& of);
/// Returns the energy stored in this rank's elements.
double stored_energy(const Body& body, std::span<const double> u);

}  // namespace kacanov
