// SPDX-License-Identifier: BSD-3-Clause
// Whether linear tetrahedra flow: they lock there.
#include <algorithm>

#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {

/// From here on a beam of 421,443 unknowns is some percent too stiff, coarser ones more.
constexpr double much_flow = 10.0;

void locked_flow(const Result& result, const Model& model, Warnings& warnings) {
  if (result.element != ElementType::tet4 || !(result.max_flow.value > much_flow)) return;
  if (std::all_of(model.materials.begin(), model.materials.end(), [](const MaterialEntry& entry) {
        return entry.formulation == MaterialEntry::Formulation::mixed;
      }))
    return;
  warnings.push_back("strains reach " + rounded(result.max_flow.value) + " times those at yield (element " +
                     std::to_string(result.max_flow.tag) + " at " +
                     to_text(result.max_flow.at, result.body.dim) +
                     "): tet4 is too stiff where bodies flow; with \"formulation\": \"mixed\" in material it "
                     "is much less so, "
                     "and \"order\": 2 in mesh makes tet10 of it, which is not");
}

}  // namespace kacanov::validity
