// SPDX-License-Identifier: BSD-3-Clause
// Whether displacements are small beside the body.
#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

/// Of the body's size.
constexpr double large_share = 0.1;

}  // namespace

void large_displacement(const Result& result, Warnings& warnings) {
  const Extreme& extreme = result.max_displacement;
  if (!(extreme.value > large_share * result.body.size)) return;
  warnings.push_back("the body moves by " + rounded(extreme.value) + ", " +
                     rounded(extreme.value / result.body.size) + " of its size (node " +
                     std::to_string(extreme.tag) + " at " + to_text(extreme.at, result.body.dim) +
                     "): forces, gaps and normals are those of the undeformed body");
}

}  // namespace kacanov::validity
