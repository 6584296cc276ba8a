// SPDX-License-Identifier: BSD-3-Clause
// Whether anything acts on the body.
#include <algorithm>

#include "validity/checks.hpp"

namespace kacanov::validity {

void no_load(const Problem& problem, const Model& model, Warnings& warnings) {
  if (any_moves(model)) return;
  const auto is_zero = [](double value) { return value == 0.0; };
  if (!std::all_of(problem.load.begin(), problem.load.end(), is_zero)) return;
  if (!std::all_of(problem.forces.begin(), problem.forces.end(),
                   [&](const EntryForce& force) { return is_zero(force.value); }))
    return;
  if (!std::all_of(problem.prescribed.begin(), problem.prescribed.end(), is_zero)) return;
  if (std::any_of(problem.directions.begin(), problem.directions.end(),
                  [](const HeldDirection& held) { return held.value != 0.0; }))
    return;
  if (std::any_of(problem.contact.begin(), problem.contact.end(),
                  [](const ContactPoint& point) { return point.gap < 0.0; }))
    return;
  warnings.push_back(
      "nothing acts on the body: there is no load, no prescribed displacement other than zero and no "
      "obstacle "
      "that presses in");
}

}  // namespace kacanov::validity
