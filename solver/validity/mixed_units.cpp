// SPDX-License-Identifier: BSD-3-Clause
// Whether Young's modulus, yield stress and loads can be in one system of units.
#include <algorithm>
#include <cmath>
#include <limits>

#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

// Metals and polymers yield at strains of 1e-4 to 0.1; a factor of 1000, as between MPa and GPa or Pa and
// kPa, is beyond these.
constexpr double least_yield_strain = 1e-5, most_yield_strain = 0.3;
// Of Young's modulus: more crushes every body, less is a million times below what moves one.
constexpr double least_load = 1e-9, most_load = 0.1;
// Of the yield stress: kN for N, where loads come to 2 % of it and more.
constexpr double most_over_yield = 20.0;

/// In tension.
double yield_stress(const Law& law) {
  const double x = law.proof_strain();
  return std::sqrt(1.5) * 2.0 * law.secant(x) * x;
}

void check_material(const Law& law, const std::string& path, Warnings& warnings) {
  if (law.linear() || !std::isfinite(law.proof_strain())) return;
  const double strain = yield_stress(law) / young_modulus(law);
  if (strain >= least_yield_strain && strain <= most_yield_strain) return;
  warnings.push_back(path + ": it yields at a stress of " + rounded(yield_stress(law)) + ", which is " +
                     rounded(strain) + " of its Young's modulus " + rounded(young_modulus(law)) +
                     ": are both in the same units?");
}

double area(const Mesh& mesh, const std::vector<std::int32_t>& facets) {
  double sum = 0.0;
  for (const std::int32_t f : facets)
    for (const double weight : consistent_weights(mesh, f).area) sum += weight;
  return sum;
}

/// Of a load; 0 for a displacement. A body force presses with all that is above.
double stress_of(const BoundaryEntry& entry, std::size_t index, const Selection& selection, const Mesh& mesh,
                 double size) {
  if (entry.traction) return norm(*entry.traction);
  if (entry.pressure) return std::abs(*entry.pressure);
  if (entry.body_force) return norm(*entry.body_force) * size;
  if (entry.node_force)
    return norm(*entry.node_force) *
           static_cast<double>(selection.nodes(entry.on, entry_name(entry, index)).size()) /
           std::pow(size, mesh.dim() - 1);
  if (entry.total_force)
    return norm(*entry.total_force) / area(mesh, selection.facets(entry.on, entry_name(entry, index)));
  return 0.0;
}

}  // namespace

void mixed_units(const Problem& problem, const Model& model, Warnings& warnings) {
  double softest = std::numeric_limits<double>::max(), stiffest = 0.0, strongest = 0.0;
  for (std::size_t i = 0; i < problem.laws.size(); ++i) {
    check_material(problem.laws[i], "material[" + std::to_string(i) + "]", warnings);
    softest = std::min(softest, young_modulus(problem.laws[i]));
    stiffest = std::max(stiffest, young_modulus(problem.laws[i]));
    const bool yields = !problem.laws[i].linear() && std::isfinite(problem.laws[i].proof_strain());
    strongest = std::max(strongest, yields ? yield_stress(problem.laws[i]) : HUGE_VAL);
  }
  const Selection selection(problem.mesh);
  const double size = extent(problem.mesh).size;
  double largest = 0.0;
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const double stress = stress_of(model.boundary[i], i, selection, problem.mesh, size);
    largest = std::max(largest, stress);
    const std::string comes =
        entry_name(model.boundary[i], i) + ": it comes to a stress of " + rounded(stress);
    if (stress > most_load * stiffest)
      warnings.push_back(comes + ", more than a tenth of Young's modulus " + rounded(stiffest) +
                         ": are both in the same units?");
    else if (stress > most_over_yield * strongest)
      warnings.push_back(comes + ", " + rounded(stress / strongest) + " times the stress " +
                         rounded(strongest) + " at which the body yields: are both in the same units?");
  }
  if (largest > 0.0 && largest < least_load * softest)
    warnings.push_back("boundary: the largest load comes to a stress of " + rounded(largest) +
                       ", less than a billionth of Young's modulus " + rounded(softest) +
                       ": are both in the same units?");
}

}  // namespace kacanov::validity
