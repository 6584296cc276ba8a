// SPDX-License-Identifier: BSD-3-Clause
// The units that the numbers of a part are in.
#pragma once

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

}  // namespace kacanov
