// SPDX-License-Identifier: BSD-3-Clause
// Finds the elements that hold the probe points.
#pragma once

#include <kacanov/problem.hpp>

namespace kacanov {

/// One Probe a point of model.probes. Points off the body by less than 1e-6 of an element are taken to lie on
/// its boundary; any other outside point is an InputError that names the nearest node.
std::vector<Probe> locate_probes(const Mesh& mesh, const Model& model);

}  // namespace kacanov
