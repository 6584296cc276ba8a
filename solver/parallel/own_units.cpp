// SPDX-License-Identifier: BSD-3-Clause
// Chooses the units of a part and takes it there and back.
#include "parallel/own_units.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "parallel/body_extent.hpp"

namespace kacanov {
namespace {

double power_below(double value) { return std::ldexp(1.0, std::ilogb(value)); }

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

/// Parameters of a form in units of its argument and of moduli. One that is added says here what its own are.
template <class Form>
void measure(Form& form, double argument, double modulus) {
  if constexpr (std::is_same_v<Form, laws::Table>) {
    scale(form.x, 1.0 / argument);
    scale(form.s, 1.0 / (modulus * argument));
  } else if constexpr (!std::is_same_v<Form, laws::Linear>) {
    form.x0 /= argument;  // the others have none
  }
}

void measure(Law& law, const UnitSystem& units) {
  law.bulk /= units.modulus;
  law.shear /= units.modulus;
  const bool squared = law.argument == Law::Argument::squared;
  const double argument = squared ? units.strain() * units.strain() : units.strain();
  std::visit([&](auto& form) { measure(form, argument, units.modulus); }, law.form);
}

/// Multiplies all that has a unit, but for the laws.
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

InOwnUnits::InOwnUnits(Part& part) : part_(part), units_(units_of(part)), laws_(part.laws) {
  for (Law& law : laws_) measure(law, units_);
  enter();
}

InOwnUnits::~InOwnUnits() { leave(); }

void InOwnUnits::enter() {
  scale(part_, units_.inverse());
  part_.laws.swap(laws_);
}

void InOwnUnits::leave() {
  scale(part_, units_);
  part_.laws.swap(laws_);
}

}  // namespace kacanov
