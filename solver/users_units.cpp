// SPDX-License-Identifier: BSD-3-Clause
// From the units of a part to its user's: everything that has a unit in what a run reports.
#include "users_units.hpp"

namespace kacanov {
namespace {

void scale(Vector3& vector, double factor) {
  for (double& value : vector) value *= factor;
}

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

/// Of what a part has of forces: the whole thickness.
double force_of(const UnitSystem& units) { return units.force() * units.thickness; }

void scale(Resultant& resultant, const UnitSystem& units) {
  scale(resultant.force, force_of(units));
  scale(resultant.moment, force_of(units) * units.length);
}

void scale(ContactTotals& contact, const UnitSystem& units) {
  scale(contact.total, units);
  scale(contact.normal_force, force_of(units));
  scale(contact.friction_force, force_of(units));
  contact.area *= units.area() * units.thickness;
  contact.max_pressure *= units.stress();
  contact.least_gap *= units.displacement;
  contact.first_gap *= units.displacement;
}

void scale(Extreme& extreme, double factor, double length) {
  extreme.value *= factor;
  scale(extreme.at, length);
}

void scale(BodySize& body, const UnitSystem& units) {
  const double length = units.length;
  scale(body.lower, length);
  scale(body.upper, length);
  body.size *= length;
  body.volume *= units.dim == 2 ? length * length * units.thickness : length * length * length;
}

/// What boundary entries load the body with is in the user's units throughout, of a thickness of 1.
void to_users_units(Result& result, const UnitSystem& units) {
  for (ContactTotals& contact : result.contact) scale(contact, units);
  for (BoundaryTotals& reaction : result.reaction) scale(reaction.total, units);
  for (BoundaryTotals& load : result.load) {
    scale(load.total.force, units.thickness);
    scale(load.total.moment, units.thickness);
  }
  scale(result.max_displacement, units.displacement, units.length);
  scale(result.max_strain, units.strain(), units.length);
  scale(result.max_flow, 1.0, units.length);
  scale(result.max_rotation, units.strain(), units.length);
  scale(result.body, units);
  scale(result.r, units.penalty());
  result.lambda_min /= units.penalty();
  result.lambda_max /= units.penalty();
  result.r_star *= units.penalty();
  result.r_active *= units.penalty();
  scale(result.contact_force, force_of(units));
  scale(result.friction_force, force_of(units));
  result.max_contact_pressure *= units.stress();
  result.max_von_mises *= units.stress();
  for (Vector3& probe : result.probe) scale(probe, units.displacement);
}

}  // namespace

void to_users_units(Solution& solution, const UnitSystem& units) {
  to_users_units(solution.result, units);
  scale(solution.displacement, units.displacement);
  scale(solution.thermal, units.stress());
  scale(solution.gap, units.displacement);
  scale(solution.pressure, units.stress());
  for (Vector3& traction : solution.traction) scale(traction, units.stress());
}

void to_users_units(LoadStep& step, const UnitSystem& units) {
  scale(step.contact_force, force_of(units));
  scale(step.friction_force, force_of(units));
  step.max_contact_pressure *= units.stress();
  for (Vector3& probe : step.probe) scale(probe, units.displacement);
}

void to_users_units(SpectrumResult& spectrum, const UnitSystem& units) {
  spectrum.lambda_min /= units.penalty();
  spectrum.lambda_max /= units.penalty();
  spectrum.bound_min /= units.penalty();
  spectrum.bound_max /= units.penalty();
  spectrum.r_star *= units.penalty();
}

void to_own_units(Start& start, const UnitSystem& units) {
  scale(start.displacement, 1.0 / units.displacement);
  scale(start.pressure, 1.0 / units.stress());
  scale(start.friction, 1.0 / units.stress());
  start.lambda_max *= units.penalty();
}

}  // namespace kacanov
