// SPDX-License-Identifier: BSD-3-Clause
// Nondimensionalisation: scales a problem so that lengths, forces and strains are of order one, and back.
#pragma once

#include <vector>

#include <kacanov/coarse_solution.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Units as powers of two, measured in the user's units: scaling changes exponents and keeps all digits
/// (theory: units). All 1: the user's own units.
struct UnitSystem {
  int dim = 3;          ///< dimension of volumes: 3 for axisymmetric bodies
  double length = 1.0;  ///< of coordinates
  /// Also of gaps; independent of `length`, because small strains never compare the two.
  double displacement = 1.0;
  double modulus = 1.0;
  /// Of a plane body, in the user's units; forces of the part are per unit thickness.
  double thickness = 1.0;

  double strain() const noexcept { return displacement / length; }
  double stress() const noexcept { return modulus * strain(); }
  double area() const noexcept { return dim == 2 ? length : length * length; }  ///< of facets
  double force() const noexcept { return stress() * area(); }
  double energy() const noexcept { return force() * displacement; }
  double penalty() const noexcept { return modulus / length; }  ///< stress over displacement
  /// Returns the factors that convert from the user's units to these.
  UnitSystem inverse() const noexcept { return {dim, 1.0 / length, 1.0 / displacement, 1.0 / modulus}; }
};

/// Computes the units: the body's extent, the middle of its moduli, and the displacement scale of loads,
/// prescribed displacements and indentations, each rounded down to a power of two. The same on every rank.
/// Collective.
UnitSystem units_of(const Part& part);

/// Scales a part to nondimensional units during the object's lifetime, and restores it bit for bit
/// afterwards.
class Nondimensionalised {
 public:
  /// Collective.
  explicit Nondimensionalised(Part& part);
  ~Nondimensionalised();
  Nondimensionalised(const Nondimensionalised&) = delete;
  Nondimensionalised& operator=(const Nondimensionalised&) = delete;

  const UnitSystem& units() const noexcept { return units_; }

 private:
  friend class Redimensionalised;
  /// Convert to and from the nondimensional units; both swap the laws.
  void enter();
  void leave();

  Part& part_;
  UnitSystem units_;
  std::vector<Law> laws_;  ///< in the units that the part is currently not in
};

/// Restores the user's units temporarily, during the object's lifetime.
class Redimensionalised {
 public:
  explicit Redimensionalised(Nondimensionalised& own) : own_(own) { own_.leave(); }
  ~Redimensionalised() { own_.enter(); }
  Redimensionalised(const Redimensionalised&) = delete;
  Redimensionalised& operator=(const Redimensionalised&) = delete;

 private:
  Nondimensionalised& own_;
};

/// Convert to the user's units. Load steps in a result are skipped: they are converted when each step ends.
void redimensionalise(Solution& solution, const UnitSystem& units);
void redimensionalise(LoadStep& step, const UnitSystem& units);
void redimensionalise(SpectrumResult& spectrum, const UnitSystem& units);

/// Converts an initial guess from the user's units.
void nondimensionalise(Start& start, const UnitSystem& units);

}  // namespace kacanov
