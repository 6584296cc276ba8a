// SPDX-License-Identifier: BSD-3-Clause
// The `material` entries of a case: elastic constants and laws.
#pragma once

#include <string>
#include <vector>

#include <kacanov/law.hpp>
#include "case/json_node.hpp"

namespace kacanov {

/// Returns the law given by elastic constants and a `law` object. Adds a warning for values that are allowed
/// but probably wrong.
Law parse_law(double young, double poisson, const Node& node, std::vector<std::string>& warnings);

/// Returns the law of a `plastic` table: rows of uniaxial true stress and equivalent plastic strain (theory:
/// uniaxial).
Law parse_plastic(double young, double poisson, const Node& node);

/// Returns the bilinear law of `yield_stress` and `tangent_modulus`.
Law parse_bilinear(double young, double poisson, const Object& material);

/// Returns the law of a `material` entry: elastic constants and `law`, `plastic` or `tangent_modulus`, if
/// any. Adds warnings as parse_law() does.
Law parse_material_law(const Object& material, std::vector<std::string>& warnings);

}  // namespace kacanov
