// SPDX-License-Identifier: BSD-3-Clause
// Limits the bulk modulus of laws for preconditioners in single precision.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "multigrid/multigrid_body.hpp"

namespace kacanov {

/// Limits the bulk modulus to 1e5 times the shear modulus: of an entry's seven digits in single precision,
/// shear keeps two (theory: softened-bulk).
inline std::vector<Law> softened(std::span<const Law> laws) {
  constexpr double stiffest_bulk = 1e5;
  std::vector<Law> soft(laws.begin(), laws.end());
  for (Law& law : soft) law.bulk = std::min(law.bulk, stiffest_bulk * law.secant(0.0));
  return soft;
}

inline MultigridBody with_laws(MultigridBody body, std::span<const Law> laws) {
  body.body.laws = laws;
  return body;
}

}  // namespace kacanov
