// SPDX-License-Identifier: BSD-3-Clause
// User-defined laws: values from their callbacks at the points of a handle's body.
#pragma once

#include <span>
#include <vector>

#include <kacanov/reference.hpp>

struct kacanov_operator;

namespace kacanov::c_api {

/// Values of the laws at a displacement, elements × points.
struct PointValues {
  std::vector<double> x, secant, derivative, energy;
  PointModuli moduli() const { return {secant, derivative, energy}; }
};

struct WantedValues {
  bool derivative = false, energy = false;
};

/// Evaluates every law, user-defined or not, at u. Throws Fault if a callback returns an error or an invalid
/// modulus.
PointValues ask_laws(kacanov_operator& op, std::span<const double> u, WantedValues wanted);

}  // namespace kacanov::c_api
