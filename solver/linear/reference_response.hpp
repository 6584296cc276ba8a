// SPDX-License-Identifier: BSD-3-Clause
// Response of a part by the reference operator: internal forces and energy, with free thermal strains and the
// mean dilatation at corners.
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Returns the free strains of the elements of a body in plane stress, from its thermal pressures
/// (ThermalPressure), in the units of their laws (theory: expansion-in-plane).
std::vector<double> free_strain(const Body& body, std::span<const double> pressure);
/// The same for a part; empty except in plane stress with a temperature.
std::vector<double> free_strain(const Part& part, std::span<const double> pressure);

struct ReferenceState {
  std::span<const double> u;
  std::span<const double> strain;             ///< free_strain(), or empty if all laws are linear
  std::span<const double> corner_dilatation;  ///< corner_dilatation() of u
};

/// Computes R(u) plus the thermal part of the load in `internal`, and returns the energy whose gradient that
/// is, for this rank's elements only, with the reference operator.
double reference_response(const Part& part, const ReferenceState& state, std::span<double> internal);

}  // namespace kacanov
