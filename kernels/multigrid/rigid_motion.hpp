// SPDX-License-Identifier: BSD-3-Clause
// Rigid motions of an aggregate, and their displacements and forces.
#pragma once

#include <array>
#include <cstddef>

#include <kacanov/vector3.hpp>

namespace kacanov {

/// M = 3 (2D: two translations, a rotation) or 6 (3D) coefficients of a rigid motion u(x) = t + θ × (x −
/// centre) / length.
template <int M>
struct RigidMotion {
  static constexpr int modes = M;
  static constexpr int dim = M == 6 ? 3 : 2;

  /// Displacement at x − centre = d for each motion: the matrix of add_motion.
  using Rows = std::array<std::array<double, static_cast<std::size_t>(M)>, static_cast<std::size_t>(dim)>;
  static Rows rows(const double* d, double inverse_length) {
    const double x = d[0] * inverse_length, y = d[1] * inverse_length;
    if constexpr (M == 6) {
      const double z = d[2] * inverse_length;
      return {{{1, 0, 0, 0, z, -y}, {0, 1, 0, -z, 0, x}, {0, 0, 1, y, -x, 0}}};
    } else {
      return {{{1, 0, -y}, {0, 1, x}}};
    }
  }

  /// u += displacement at x − centre = d of the motion with coefficients q.
  template <class S>
  static void add_motion(const S* q, const double* d, double inverse_length, S* u) {
    if constexpr (M == 6) {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length),
              z = static_cast<S>(d[2] * inverse_length);
      u[0] += q[0] + q[4] * z - q[5] * y;
      u[1] += q[1] + q[5] * x - q[3] * z;
      u[2] += q[2] + q[3] * y - q[4] * x;
    } else {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length);
      u[0] += q[0] - q[2] * y;
      u[1] += q[1] + q[2] * x;
    }
  }
  /// q += generalised forces of the force f at x − centre = d: the transpose of add_motion.
  template <class S>
  static void add_force(const S* f, const double* d, double inverse_length, S* q) {
    if constexpr (M == 6) {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length),
              z = static_cast<S>(d[2] * inverse_length);
      q[0] += f[0];
      q[1] += f[1];
      q[2] += f[2];
      q[3] += f[2] * y - f[1] * z;
      q[4] += f[0] * z - f[2] * x;
      q[5] += f[1] * x - f[0] * y;
    } else {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length);
      q[0] += f[0];
      q[1] += f[1];
      q[2] += f[1] * x - f[0] * y;
    }
  }

  /// q += coefficients, in a part with its centre at d, of the motion `from` of a larger aggregate.
  template <class S>
  static void add_to_part(const S* from, const double* d, double inverse_length, S* q) {
    add_motion(from, d, inverse_length, q);
    for (int m = dim; m < M; ++m) q[m] += from[m];
  }
  /// The transpose: q += generalised forces on the larger aggregate from those on the part, `f`.
  template <class S>
  static void add_from_part(const S* f, const double* d, double inverse_length, S* q) {
    add_force(f, d, inverse_length, q);
    for (int m = dim; m < M; ++m) q[m] += f[m];
  }
};

}  // namespace kacanov
