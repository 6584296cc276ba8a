// SPDX-License-Identifier: BSD-3-Clause
// Temperature in plane stress: what elements would be longer by if nothing acted on them.
#include "linear/free_strain.hpp"

#include <numeric>

#include <kacanov/reference.hpp>
#include "law/plane_stress.hpp"

namespace kacanov {

std::vector<double> free_strain(const Part& part, std::span<const double> pressure) {
  return part.plane == PlaneState::stress && !pressure.empty() ? free_strain(part.body(), pressure)
                                                               : std::vector<double>();
}

std::vector<double> free_strain(const Body& body, std::span<const double> pressure) {
  std::vector<double> strain(pressure.begin(), pressure.end());
  for (std::size_t e = 0; e < strain.size(); ++e) strain[e] /= plane_stress_expansion(body.law(e));
  return strain;
}

double reference_response(const Part& part, const ReferenceState& state, std::span<double> internal) {
  const auto& [u, strain, dilatation] = state;
  Body body = part.body();
  body.free_strain = strain;
  body.corner_dilatation = dilatation;
  const double energy = reference::response(body, u, internal);
  if (strain.empty()) return energy;
  std::vector<double> load(part.unknowns());
  const double free = reference::free_force(body, load);
  for (std::size_t i = 0; i < load.size(); ++i) internal[i] += load[i];
  return std::inner_product(load.begin(), load.end(), u.begin(), energy - free);
}

}  // namespace kacanov
