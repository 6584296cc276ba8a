// SPDX-License-Identifier: BSD-3-Clause
// Whether enough nodes touch for a contact pressure to be one.
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Nodes under a ball that is smaller than the facets round it; on lines the same by lines.
constexpr std::int64_t few_in_space = 3, few_in_plane = 1;
/// A face that touches with all it has is no matter of the mesh.
constexpr std::int64_t many_open = 10;

}  // namespace

void coarse_contact(const Result& result, const Model& model, Warnings& warnings) {
  const std::int64_t few = result.body.dim == 2 ? few_in_plane : few_in_space;
  for (const ContactTotals& contact : result.contact) {
    const std::int64_t touching = contact.sticking + contact.slipping;
    if (touching == 0 || touching > few || contact.open < many_open) continue;
    const std::size_t i = contact.entry;
    warnings.push_back(
        entry_name(model.contact[i], i) + ": only " + std::to_string(touching) + " of " +
        std::to_string(touching + contact.open) +
        " nodes bear its pressure: its force is right in sum, but pressure and stress there are "
        "those of so coarse a mesh");
  }
}

}  // namespace kacanov::validity
