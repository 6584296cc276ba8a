// SPDX-License-Identifier: BSD-3-Clause
// Whether Tresca's friction acts where nothing presses.
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Share of an entry's friction that nobody would miss.
constexpr double little = 1e-3;

}  // namespace

void open_friction(const Result& result, const Model& model, Warnings& warnings) {
  for (const ContactTotals& contact : result.contact) {
    const std::size_t i = contact.entry;
    const ContactEntry& entry = model.contact[i];
    if (!entry.friction || entry.friction->tresca == 0.0 || !(contact.open_friction > little)) continue;
    warnings.push_back(entry_name(entry, i) + ".friction: " + rounded(100.0 * contact.open_friction) +
                       " % of it acts at nodes without pressure (" + std::to_string(contact.open) +
                       " are open), where Tresca's bound holds as well; Coulomb's asks for pressure");
  }
}

}  // namespace kacanov::validity
