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

/// R(u) + what the load has of temperature, and the energy whose slope that is, of this rank's elements
/// alone, by the reference operator. Collective. `strain`: free_strain(), or empty where all laws are linear.
double reference_response(const Part& part, std::span<const double> strain, std::span<const double> u,
                          std::span<double> internal);

}  // namespace kacanov
