// SPDX-License-Identifier: BSD-3-Clause
// The `material` entries of a case: elastic constants and laws.
#pragma once

#include <string>
#include <vector>

#include <kacanov/law.hpp>
#include "case/json_node.hpp"

namespace kacanov {

/// The law of a material from its elastic constants and its `law` object. Adds to `warnings` what is
/// allowed but looks mistaken.
Law parse_law(double young, double poisson, const Node& node, std::vector<std::string>& warnings);

/// The law of `plastic`: rows of uniaxial true stress and equivalent plastic strain (theory: uniaxial).
Law parse_plastic(double young, double poisson, const Node& node);

/// The law of a material's `yield_stress` and `tangent_modulus`.
Law parse_bilinear(double young, double poisson, const Object& material);

/// The law of a whole material, by its elastic constants and those of the keys above that it has. Adds to
/// `warnings` likewise.
Law parse_material_law(const Object& material, std::vector<std::string>& warnings);

}  // namespace kacanov
