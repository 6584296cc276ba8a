// SPDX-License-Identifier: BSD-3-Clause
// What temperature does to a body that cannot expand.
#pragma once

#include <span>

#include <kacanov/reference.hpp>

namespace kacanov::reference {

/// What elements push their nodes with that press by `pressure`, ∫ p div v (overwrites f): one value an
/// element, or 1 + corners of them, of which those at the corners count, linear in between (theory:
/// expansion). Returns the energy that the elastic body stores where it cannot expand.
double expansion_force(const Body& body, std::span<const double> pressure, std::span<double> f);

}  // namespace kacanov::reference
