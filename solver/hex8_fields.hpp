// SPDX-License-Identifier: BSD-3-Clause
// Stress and strain of trilinear hexahedra.
#pragma once

#include <span>

#include <kacanov/reference.hpp>

namespace kacanov::hex8 {

/// reference::fields(), point_fields(), energy() and volumes() of a body of hex8, some elements abreast; to
/// rounding the same. Body::moduli is taken to be null.
void fields(const Body& body, std::span<const double> u, const reference::ElementFields& out);
void point_fields(const Body& body, std::span<const double> u, const reference::PointFields& out);
double energy(const Body& body, std::span<const double> u);
void volumes(const Body& body, std::span<double> volume);

}  // namespace kacanov::hex8
