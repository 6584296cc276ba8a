// SPDX-License-Identifier: BSD-3-Clause
// Whether B-bar was declined where elements lock without it.
#include "problem/conditions.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {

void locking(const Problem& problem, const Model& model, Warnings& warnings) {
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const MaterialEntry& entry = model.materials[i];
    if (entry.bbar.value_or(true) || !locks_without_bbar(entry.law, problem.mesh.type)) continue;
    warnings.push_back("material[" + std::to_string(i) + "].bbar: it is false, and " +
                       std::string(cell(problem.mesh.type).name) +
                       " elements of a plastic or nearly incompressible body are too stiff without");
  }
}

}  // namespace kacanov::validity
