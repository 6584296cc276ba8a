// SPDX-License-Identifier: BSD-3-Clause
// Whether strains and rotations are small, as the theory takes them to be.
#include <algorithm>

#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Stress and equilibrium are then off by about as much.
constexpr double small_enough = 0.05;

std::string place(const Extreme& extreme, const Result& result) {
  return " (element " + std::to_string(extreme.tag) + " at " + to_text(extreme.at, result.body.dim) + ")";
}

}  // namespace

void large_strain(const Result& result, Warnings& warnings) {
  const Extreme &strain = result.max_strain, &rotation = result.max_rotation;
  if (strain.value > small_enough)
    warnings.push_back("strains reach " + rounded(strain.value) + place(strain, result) +
                       ": this is a theory of small strains, good to some percent up to 0.05");
  if (rotation.value > small_enough)
    warnings.push_back("rotations reach " + rounded(rotation.value) + " radians" + place(rotation, result) +
                       ": this is a theory of small rotations, good to some percent up to 0.05");
}

}  // namespace kacanov::validity
