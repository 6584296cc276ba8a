// SPDX-License-Identifier: BSD-3-Clause
// Lanczos estimates for the penalty: r*, and r_A of an active set, with bounds (theory: lanczos).
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
  int max_cg = SolverOptions{}.max_cg;  ///< CG iterations per product
};

/// Accumulated cost of several estimates.
struct SpectrumCost {
  int products = 0;
  std::int64_t cg_iterations = 0;
  bool converged = true;  ///< every solve and every Lanczos run
};

/// An eigenvalue within `bound` of `value`: the Ritz residual plus the error of the underlying solve.
struct Eigenvalue {
  double value = 0.0, bound = 0.0;
};

/// Extreme eigenvalues of the compliance K (theory: compliance, lanczos, lanczos-loose), in units of length
/// per stress. All members are collective.
class Spectrum {
 public:
  /// Uses, and sets up again, `amg`; works with the secant frozen in `op` and `g` (elements × points). All
  /// arguments must outlive it.
  Spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg, std::span<const double> g,
           const SpectrumOptions& options);

  /// Computes λ_max of D^½ C B⁻¹ Cᵀ D^½ with the rows `held` fixed at zero. With loose rigid-body modes
  /// (`loose`) B⁻¹ does not exist; the largest finite eigenvalue then follows from B + r₀ CᵀDC, whose
  /// eigenvalues are λ/(1 + r₀λ).
  Eigenvalue largest(const TraceRows& rows, const TraceRows& held, double r0, bool loose);
  /// Computes λ_min (smallest nonzero) of the same without held rows, as 1/λ_max of the inverse, by the Schur
  /// complement.
  Eigenvalue smallest(const TraceRows& rows);

  const SpectrumCost& cost() const noexcept { return cost_; }

 private:
  /// B, or B + r₀ CᵀDC with penalised rows, in a space.
  struct System {
    const Space& space;
    const TraceRows* penalised = nullptr;
    double r0 = 0.0;
  };
  /// Accuracy of a product: sufficient for Lanczos, or higher with an error bound.
  enum class Accuracy { product, bounded };
  double apply(const System& system, std::span<const double> p, std::span<double> q);
  /// Adds to x the solution for the right-hand side work.residual. Returns a bound on the energy norm of the
  /// error of x, or 0 without `bounded`.
  double solve(const System& system, std::span<double> x, CgWork& work, Accuracy accuracy);
  CgResult solve_to(const System& system, std::span<double> x, CgWork& work, double relative);
  /// Runs Lanczos and adds its cost.
  LanczosResult largest_of(const Product& product, const TraceRows& rows, const LanczosOptions& options);
  /// A product that returns the energy norm of its solve's error.
  using BoundedProduct = std::function<double(std::span<const double> x, std::span<double> y)>;
  /// Returns the Rayleigh quotient of pair `i` and its bound (theory: lanczos-bounds). `gain`: largest error
  /// of the product per unit energy norm of the solve's error.
  Eigenvalue bounded(const LanczosResult& found, std::size_t i, const BoundedProduct& product, double gain);

  const Part* part_;
  DistributedOperator* op_;
  Preconditioner* amg_;
  std::span<const double> g_;
  SpectrumOptions options_;
  SpectrumCost cost_;
};

/// Estimates λ_min without a solve from the stiffest contact row, nᵀ diag(B) n / mass (theory:
/// first-penalty); 0 without contact. `diagonal`: of the part's unknowns. Collective.
double rough_lambda_min(const Part& part, std::span<const float> diagonal, bool friction);
/// Estimates λ_max with the rows `held` at zero from below: uᵀCᵀDCu / uᵀBu for the result u of at most
/// `steps` CG iterations under a uniform pressure on `rows`. `amg` is used as it is and may include
/// penalties. Collective.
double rough_lambda_max(const Part& part, DistributedOperator& op, Preconditioner& amg, const TraceRows& rows,
                        const TraceRows& held, int steps);

/// Computes λ_min, λ_max and r* (theory: r-star) for N, or with `friction` for [N; T], with g (elements ×
/// points) frozen in `op`. Collective.
SpectrumResult estimate_spectrum(const Part& part, DistributedOperator& op, Preconditioner& amg,
                                 std::span<const double> g, bool friction, const SpectrumOptions& options);

}  // namespace kacanov
