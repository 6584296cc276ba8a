// SPDX-License-Identifier: BSD-3-Clause
// Largest eigenvalue of D⁻¹A, for the smoothers.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>

namespace kacanov {

/// Returns a pseudorandom number in [−1, 1] that depends only on the index.
inline float scatter(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15U;  // splitmix64
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<float>(static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0);
}

/// Start vector for largest_eigenvalue: `components` scatter()ed entries per index of the map.
template <class S>
std::vector<S> scattered(const IndexMap& map, std::size_t components) {
  std::vector<S> x(map.size() * components);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = static_cast<S>(
        scatter(static_cast<std::uint64_t>(map.number(i / components)) * components + i % components));
  return x;
}

/// Λ (theory: chebyshev): Lanczos' estimate after ten steps of conjugate gradients preconditioned by D, plus
/// a tenth because it is a lower bound; 1 if the start is zero. `r` holds the start and is overwritten.
/// `multiply(x, y)`: y = A x; `scale(x, y)`: y = D⁻¹ x, on vectors of r's length; `dot` sums over owned
/// entries and all ranks. Collective if these are.
template <class S, class Multiply, class Scale, class Dot>
double largest_eigenvalue(std::vector<S>& r, const Multiply& multiply, const Scale& scale, const Dot& dot) {
  constexpr int steps = 10;
  std::vector<S> z(r.size()), p(r.size()), q(r.size());
  std::vector<double> diagonal, off;
  double rz = 0.0, alpha = 1.0;
  for (int k = 0; k < steps; ++k) {
    scale(std::span<const S>(r), std::span<S>(z));
    const double rz_new = dot(r, z);
    if (!(rz_new > 0.0)) break;
    const double beta = k == 0 ? 0.0 : rz_new / rz;
    rz = rz_new;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = k == 0 ? z[i] : z[i] + static_cast<S>(beta) * p[i];
    multiply(std::span<S>(p), std::span<S>(q));
    const double pq = dot(p, q);
    if (!(pq > 0.0)) break;
    const double before = alpha;
    alpha = rz / pq;
    diagonal.push_back(1.0 / alpha + (k == 0 ? 0.0 : beta / before));
    if (k > 0) off.push_back(std::sqrt(beta) / before);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= static_cast<S>(alpha) * q[i];
  }
  if (diagonal.empty()) return 1.0;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(
      Eigen::Map<const Eigen::VectorXd>(diagonal.data(), static_cast<Eigen::Index>(diagonal.size())),
      Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size())),
      Eigen::EigenvaluesOnly);
  return 1.1 * solver.eigenvalues().maxCoeff();
}

}  // namespace kacanov
