// SPDX-License-Identifier: BSD-3-Clause
// Units in which lengths, forces and strains of a problem are about one, and the way there and back.
#pragma once

#include <vector>

#include <kacanov/coarse_solution.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Powers of two, measured in the user's units: numbers change their exponents and keep their digits (theory:
/// units). All 1: the user's own.
struct UnitSystem {
  int dim = 3;                ///< of volumes: 3 in axisymmetric bodies
  double length = 1.0;        ///< of coordinates
  double displacement = 1.0;  ///< of gaps, too: small strains set nothing of it against lengths
  double modulus = 1.0;
  double thickness =
      1.0;  ///< of a plane body, in the user's units; forces of the part are of a thickness of 1

  double strain() const noexcept { return displacement / length; }
  double stress() const noexcept { return modulus * strain(); }
  double area() const noexcept { return dim == 2 ? length : length * length; }  ///< of facets
  double force() const noexcept { return stress() * area(); }
  double energy() const noexcept { return force() * displacement; }
  double penalty() const noexcept { return modulus / length; }  ///< stress over displacement
  /// What takes numbers in the user's units to these by multiplication.
  UnitSystem inverse() const noexcept { return {dim, 1.0 / length, 1.0 / displacement, 1.0 / modulus}; }
};

/// The body's extent, the middle of its moduli, and the displacement that loads, prescribed displacements and
/// indentations come to, each as the power of two below. The same on every rank. Collective.
UnitSystem units_of(const Part& part);

/// A part in its own units while this lives, and in the user's, to the bit, before and after.
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
  /// There and back; each swaps the laws.
  void enter();
  void leave();

  Part& part_;
  UnitSystem units_;
  std::vector<Law> laws_;  ///< in the units that the part is not in
};

/// In between, the same part in its user's units.
class Redimensionalised {
 public:
  explicit Redimensionalised(Nondimensionalised& own) : own_(own) { own_.leave(); }
  ~Redimensionalised() { own_.enter(); }
  Redimensionalised(const Redimensionalised&) = delete;
  Redimensionalised& operator=(const Redimensionalised&) = delete;

 private:
  Nondimensionalised& own_;
};

/// Multiplies by the units. Load steps in a result are left alone: each is in the user's units from its end
/// on.
void redimensionalise(Solution& solution, const UnitSystem& units);
void redimensionalise(LoadStep& step, const UnitSystem& units);
void redimensionalise(SpectrumResult& spectrum, const UnitSystem& units);

/// The other way: what a run starts from.
void nondimensionalise(Start& start, const UnitSystem& units);

}  // namespace kacanov
