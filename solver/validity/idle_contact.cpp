// SPDX-License-Identifier: BSD-3-Clause
// Whether every contact entry bears something.
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Of the body's size: what touches at rest.
constexpr double closed = 1e-6;

}  // namespace

void idle_contact(const Result& result, const Model& model, Warnings& warnings) {
  for (const ContactTotals& contact : result.contact) {
    if (contact.sticking + contact.slipping > 0) continue;
    const std::size_t i = contact.entry;
    const std::string name = entry_name(model.contact[i], i);
    if (contact.first_gap <= closed * result.body.size)
      warnings.push_back(name +
                         ": the body touches this obstacle at rest, and the loads lift it off: no node "
                         "bears pressure, the least gap is " +
                         rounded(contact.least_gap));
    else
      warnings.push_back(name + ": nothing reaches this obstacle; of the least gap of " +
                         rounded(contact.first_gap) + " at rest " + rounded(contact.least_gap) + " is left");
  }
}

}  // namespace kacanov::validity
