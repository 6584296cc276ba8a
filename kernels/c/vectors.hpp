// SPDX-License-Identifier: BSD-3-Clause
// Vectors that come in through the C interface: of the right length, finite where they are displacements.
#pragma once

#include <cmath>
#include <string>

#include "c/handle.hpp"

namespace kacanov::c_api {

inline void require_finite(std::span<const double> values, const char* name) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Fault(KACANOV_ERROR_VALUE, std::string(name) + "[" + std::to_string(i) + "] is not finite");
}

/// A displacement: of the right length and finite.
inline std::span<const double> state(const kacanov_operator& op, std::size_t n, const double* u) {
  require_size(n, op.unknowns(), "n");
  const auto span = input(u, n, "u");
  require_finite(span, "u");
  return span;
}

}  // namespace kacanov::c_api
