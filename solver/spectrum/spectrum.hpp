// SPDX-License-Identifier: BSD-3-Clause
// Lanczos estimates behind the penalty: r* and r_A of the active set, with bounds (theory: lanczos).
#pragma once

#include <span>
#include <vector>

#include <kacanov/model.hpp>
#include <kacanov/result.hpp>
#include "contact/trace_rows.hpp"
#include "linear/distributed_operator.hpp"
#include "linear/preconditioner.hpp"
#include "multigrid/cg.hpp"
#include "spectrum/lanczos.hpp"

namespace kacanov {

struct SpectrumOptions {
  double tolerance = 1e-2;              ///< relative, on eigenvalues
  int max_cg = SolverOptions{}.max_cg;  ///< CG iterations of one product
};

/// Bookkeeping of a run of estimates.
struct SpectrumCost {
  int products = 0;
  std::int64_t cg_iterations = 0;
  bool converged = true;  ///< every solve and every Lanczos estimate
};

/// An eigenvalue lies within `bound` of the value: the Ritz residual and the error of the solve behind it.
struct Eigenvalue {
  double value = 0.0, bound = 0.0;
};

/// Extreme eigenvalues of the compliance K (theory: compliance, lanczos, lanczos-loose), units of length over
/// stress. Everything is collective.
class Spectrum {
 public:
  /// Uses (and re-sets) `amg`; works with the secant frozen in `op` and `g` (elements × points). What is
  /// passed has to outlive it.
  Spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg, std::span<const double> g,
           const SpectrumOptions& options);

  /// λ_max of D^½ C B⁻¹ Cᵀ D^½ with the rows `held` held at zero. Where rigid modes are loose (`loose`), B⁻¹
  /// does not exist; the largest finite eigenvalue is taken from B + r₀ CᵀDC, whose eigenvalues are λ/(1 + r₀
  /// λ).
  Eigenvalue largest(const TraceRows& rows, const TraceRows& held, double r0, bool loose);
  /// λ_min (smallest nonzero) of the same without held rows: 1/λ_max of the inverse, by the Schur complement.
  Eigenvalue smallest(const TraceRows& rows);

  const SpectrumCost& cost() const noexcept { return cost_; }

 private:
  /// B, or B + r₀ CᵀDC where there are rows to penalise, in a space.
  struct System {
    const Space& space;
    const TraceRows* penalised = nullptr;
    double r0 = 0.0;
  };
  /// How well a product is solved: for Lanczos, or better and with a bound on the error.
  enum class Accuracy { product, bounded };
  double apply(const System& system, std::span<const double> p, std::span<double> q);
  /// Adds to x the solution for the right-hand side work.residual. Returns a bound on the energy norm of the
  /// error of x, 0 without `bounded`.
  double solve(const System& system, std::span<double> x, CgWork& work, Accuracy accuracy);
  CgResult solve_to(const System& system, std::span<double> x, CgWork& work, double relative);
  /// Lanczos, its cost added.
  LanczosResult largest_of(const Product& product, const TraceRows& rows, const LanczosOptions& options);
  /// A product and the energy norm of the error of its solve.
  using BoundedProduct = std::function<double(std::span<const double> x, std::span<double> y)>;
  /// The Rayleigh quotient of pair `i` and its bound (theory: lanczos-bounds); an error of the energy norm 1
  /// is one of at most `gain` in the product.
  Eigenvalue bounded(const LanczosResult& found, std::size_t i, const BoundedProduct& product, double gain);

  const Part* part_;
  DistributedOperator* op_;
  Preconditioner* amg_;
  std::span<const double> g_;
  SpectrumOptions options_;
  SpectrumCost cost_;
};

/// λ_min without a solve, from the stiffest contact row, nᵀ diag(B) n / mass (theory: first-penalty); 0
/// without contact. `diagonal`: of the part's unknowns. Collective.
double rough_lambda_min(const Part& part, std::span<const float> diagonal, bool friction);
/// λ_max with the rows `held` at zero, from below: uᵀCᵀDCu / uᵀBu for what at most `steps` CG iterations make
/// of an even pressure on `rows`. `amg` as it stands: it may hold penalties. Collective.
double rough_lambda_max(const Part& part, DistributedOperator& op, Preconditioner& amg, const TraceRows& rows,
                        const TraceRows& held, int steps);

/// λ_min, λ_max, r* (theory: r-star) for N, or for [N; T] with `friction`, with g (elements × points) as
/// frozen in `op`. Collective.
SpectrumResult estimate_spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg,
                                 std::span<const double> g, bool friction, const SpectrumOptions& options);

}  // namespace kacanov
