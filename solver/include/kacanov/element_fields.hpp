// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of a solution, a run of elements at a time: for all of them they would be most of a run's
// memory.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// What stress and strain follow from. Nothing is owned.
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

/// Fields of elements `first` … `first` + `count` − 1 of the part. Spans of `out` have
/// `count` entries (stress 6 each, xx yy zz xy yz zx), or none where not wanted.
void element_fields(const Part& part, const BodyState& state, std::size_t first, std::size_t count,
                    const reference::ElementFields& out);

/// The same of a whole body.
void element_fields(const Body& body, const BodyState& state, const reference::ElementFields& out);

/// Their mean strain: elements × 6, tensor components xx yy zz xy yz zx; what temperature does is in it.
void element_strains(const Part& part, const BodyState& state, std::size_t first, std::size_t count,
                     std::span<double> out);

/// All fields of some elements in a row.
struct ElementRun {
  std::size_t first = 0;
  std::vector<double> stress, von_mises, dev_strain, secant, strain, rotation, volume;
  std::vector<std::uint8_t> plastic;
};
/// Calls visit(run) for the whole part, some thousand elements at a time.
void visit_element_fields(const Part& part, const BodyState& state,
                          const std::function<void(const ElementRun&)>& visit);

/// What the quadrature points of some elements in a row have, an element's together.
struct PointRun {
  std::size_t first = 0;  ///< element
  std::vector<Vector3> position;
  std::vector<double> stress;  ///< × 6, as of elements
  std::vector<double> strain;  ///< × 6, tensor components; what temperature does is in it
  std::vector<double> volume;
};
/// What a caller of visit_points() wants to know; the others of a run are empty.
enum class PointValues : std::uint8_t { all, all_but_stress };
/// Calls visit(run) for the whole part, some thousand elements at a time.
void visit_points(const Part& part, const BodyState& state, PointValues wanted,
                  const std::function<void(const PointRun&)>& visit);

/// Fields of one number an element, of all elements of a part: some 33 bytes each.
struct ElementNumbers {
  std::vector<double> von_mises, dev_strain, secant, volume;
  std::vector<std::uint8_t> plastic;
};
ElementNumbers element_numbers(const Part& part, const BodyState& state);

/// At the part's nodes, of the elements round a node over all ranks, weighted by volume.
struct NodalMeans {
  std::vector<double> von_mises;      ///< mean stress
  std::vector<double> plastic_share;  ///< of the volume, that belongs to plastic ones
};
/// Collective.
NodalMeans nodal_means(const Part& part, const ElementNumbers& of);
/// The energy that this rank's elements store.
double stored_energy(const Body& body, std::span<const double> u);

}  // namespace kacanov
