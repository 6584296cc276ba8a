// SPDX-License-Identifier: BSD-3-Clause
// Conversion of parts, states and results between the user's units and nondimensional ones.
#include "partition/nondimensionalisation.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "partition/global_max.hpp"

namespace kacanov {
namespace {

double power_below(double value) { return std::ldexp(1.0, std::ilogb(value)); }

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

/// Scales the parameters of a law by the units of its argument and of moduli. New laws must be added here.
template <class Form>
void measure(Form& form, double argument, double modulus) {
  if constexpr (std::is_same_v<Form, laws::Table>) {
    scale(form.x, 1.0 / argument);
    scale(form.s, 1.0 / (modulus * argument));
  } else if constexpr (!std::is_same_v<Form, laws::Linear>) {
    form.x0 /= argument;  // the other parameters are dimensionless
  }
}

void measure(Law& law, const UnitSystem& units) {
  law.bulk /= units.modulus;
  law.shear /= units.modulus;
  const bool squared = law.argument == Law::Argument::squared;
  const double argument = squared ? units.strain() * units.strain() : units.strain();
  std::visit([&](auto& form) { measure(form, argument, units.modulus); }, law.form);
}

/// Scales everything with a unit, except the laws.
void scale(Part& part, const UnitSystem& factors) {
  scale(part.coordinates, factors.length);
  scale(part.start, factors.displacement);
  scale(part.slip_origin, factors.displacement);
  for (Part::ComponentValue& entry : part.load) entry.value *= factors.force();
  for (EntryForce& entry : part.forces) entry.value *= factors.force();
  for (ThermalPressure& thermal : part.thermal) scale(thermal.of_element, factors.stress());
  for (Part::ComponentValue& entry : part.prescribed) entry.value *= factors.displacement;
  for (HeldDirection& held : part.directions) held.value *= factors.displacement;
  for (NodeSpring& spring : part.springs)
    for (Vector3& row : spring.stiffness)
      for (double& value : row) value *= factors.force() / factors.displacement;
  for (ContactPoint& point : part.contact) {
    point.gap *= factors.displacement;
    point.unknown_gap *= factors.displacement;
    point.mass *= factors.area();
    point.tresca *= factors.stress();
  }
  for (Probe& probe : part.probes)
    for (double& x : probe.point) x *= factors.length;
}

}  // namespace

UnitSystem units_of(const Part& part) {
  UnitSystem units;
  units.dim = part.plane == PlaneState::axisymmetric ? 3 : part.dim();
  units.thickness = part.thickness;
  units.length = power_below(body_extent(part));
  int stiffest = std::ilogb(part.laws.at(0).secant(0.0)), softest = stiffest;
  for (const Law& law : part.laws) {
    stiffest = std::max(stiffest, std::ilogb(law.secant(0.0)));
    softest = std::min(softest, std::ilogb(law.secant(0.0)));
  }
  units.modulus = std::ldexp(1.0, softest + (stiffest - softest) / 2);
  double moved = 0.0, load = 0.0;
  for (const auto& entry : part.prescribed) moved = std::max(moved, std::abs(entry.value));
  for (const HeldDirection& held : part.directions) moved = std::max(moved, std::abs(held.value));
  for (const ContactPoint& point : part.contact) moved = std::max(moved, -point.gap);
  for (const auto& entry : part.load) load = std::max(load, std::abs(entry.value));
  for (const auto& entry : part.forces) load = std::max(load, std::abs(entry.value));
  const double width = units.dim == 2 ? 1.0 : units.length;
  const double most = part.node_map.max_all(std::max(moved, load / units.modulus / width));
  units.displacement = most > 0.0 ? power_below(most) : units.length;
  return units;
}

Nondimensionalised::Nondimensionalised(Part& part) : part_(part), units_(units_of(part)), laws_(part.laws) {
  for (Law& law : laws_) measure(law, units_);
  enter();
}

Nondimensionalised::~Nondimensionalised() { leave(); }

void Nondimensionalised::enter() {
  scale(part_, units_.inverse());
  part_.laws.swap(laws_);
}

void Nondimensionalised::leave() {
  scale(part_, units_);
  part_.laws.swap(laws_);
}

namespace {

void scale(Vector3& vector, double factor) {
  for (double& value : vector) value *= factor;
}

/// Unit of forces on the whole thickness.
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

/// Loads of boundary entries are stored in the user's units already, per unit thickness.
void redimensionalise(Result& result, const UnitSystem& units) {
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

void redimensionalise(Solution& solution, const UnitSystem& units) {
  redimensionalise(solution.result, units);
  scale(solution.displacement, units.displacement);
  scale(solution.thermal, units.stress());
  scale(solution.gap, units.displacement);
  scale(solution.pressure, units.stress());
  for (Vector3& traction : solution.traction) scale(traction, units.stress());
}

void redimensionalise(LoadStep& step, const UnitSystem& units) {
  scale(step.contact_force, force_of(units));
  scale(step.friction_force, force_of(units));
  step.max_contact_pressure *= units.stress();
  for (Vector3& probe : step.probe) scale(probe, units.displacement);
}

void redimensionalise(SpectrumResult& spectrum, const UnitSystem& units) {
  spectrum.lambda_min /= units.penalty();
  spectrum.lambda_max /= units.penalty();
  spectrum.bound_min /= units.penalty();
  spectrum.bound_max /= units.penalty();
  spectrum.r_star *= units.penalty();
}

void nondimensionalise(Start& start, const UnitSystem& units) {
  scale(start.displacement, 1.0 / units.displacement);
  scale(start.pressure, 1.0 / units.stress());
  scale(start.friction, 1.0 / units.stress());
  start.lambda_max *= units.penalty();
}

}  // namespace kacanov
