// SPDX-License-Identifier: BSD-3-Clause
// The extremes of a body's displacement, strain and stress with their places, and its size.
#pragma once

#include <span>

#include <kacanov/element_fields.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Extremes, plastic and softening elements, and the undeformed body, over all ranks. Collective.
void collect_body_totals(const Part& part, const BodyState& state, Result& result);

}  // namespace kacanov
