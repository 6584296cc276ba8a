// SPDX-License-Identifier: BSD-3-Clause
// Forces of every model entry on the body: reactions, loads and contact.
#pragma once

#include <span>

#include <kacanov/result.hpp>
#include "contact/contact_state.hpp"
#include "linear/load_path.hpp"

namespace kacanov {

/// Fills contact, reaction and load of solution.result (theory: entry-totals) from its contact fields.
/// `internal`: R(u), consistent over ranks; `path`: the load of `state`. Collective.
void collect_entries(const Part& part, const ContactState& state, const LoadPath& path,
                     std::span<const double> internal, Solution& solution);

}  // namespace kacanov
