// SPDX-License-Identifier: BSD-3-Clause
// Laws of the caller's own: what their callbacks say at the points of a handle's body.
#pragma once

#include <span>
#include <vector>

#include <kacanov/reference.hpp>

struct kacanov_operator;

namespace kacanov::c_api {

/// What the laws say at a displacement, elements × points.
struct PointValues {
  std::vector<double> x, secant, derivative, energy;
  PointModuli moduli() const { return {secant, derivative, energy}; }
};

struct WantedValues {
  bool derivative = false, energy = false;
};

/// Asks every law, own or not, at u. Throws Fault where a callback says that it has failed, or says what no
/// modulus can be.
PointValues ask_laws(kacanov_operator& op, std::span<const double> u, WantedValues wanted);

}  // namespace kacanov::c_api
