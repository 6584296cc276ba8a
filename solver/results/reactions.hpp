// SPDX-License-Identifier: BSD-3-Clause
// What every entry of a model does to the body: forces, moments and states of contact.
#pragma once

#include <span>

#include <kacanov/result.hpp>
#include "contact/contact_state.hpp"
#include "linear/load_path.hpp"

namespace kacanov {

/// Fills contact, reaction and load of solution.result (theory: entry-totals). `solution` has its contact
/// fields; `internal`: R(u), consistent over ranks; `path`: the load that `state` belongs to. Collective.
void collect_entries(const Part& part, const ContactState& state, const LoadPath& path,
                     std::span<const double> internal, Solution& solution);

}  // namespace kacanov
