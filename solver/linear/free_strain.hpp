// SPDX-License-Identifier: BSD-3-Clause
// Temperature in plane stress: what elements would be longer by if nothing acted on them.
#pragma once

#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Of the elements of a body in plane stress, from the pressures that temperature takes off
/// (ThermalPressure), in the units of their laws (theory: expansion-in-plane).
std::vector<double> free_strain(const Body& body, std::span<const double> pressure);
/// The same of a part; empty but in plane stress, and where nothing is warmer.
std::vector<double> free_strain(const Part& part, std::span<const double> pressure);

struct ReferenceState {
  std::span<const double> u;
  std::span<const double> strain;             ///< free_strain(), or empty where all laws are linear
  std::span<const double> corner_dilatation;  ///< corner_dilatation() of u
};

/// R(u) + what the load has of temperature, and the energy whose slope that is, of this rank's elements
/// alone, by the reference operator.
double reference_response(const Part& part, const ReferenceState& state, std::span<double> internal);

}  // namespace kacanov
