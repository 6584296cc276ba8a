// SPDX-License-Identifier: BSD-3-Clause
// Results of a run: the numbers in result.json and the fields of the output files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/cells.hpp>
#include <kacanov/model.hpp>
#include <kacanov/totals.hpp>

namespace kacanov {

/// `limited_by_rounding`: rounding errors of the residuals exceed the tolerance, and further steps no longer
/// reduce the residuals (theory: rounding).
enum class Status { converged, limited_by_rounding, not_converged, interrupted };

/// The KKT residuals of a state, relative to scales computed from that state (theory: kkt, duality-gap,
/// rounding).
struct KktResiduals {
  double equilibrium = 0.0;  ///< ‖F − R(u) − Nᵀ M λ_n − Tᵀ M λ_t‖ on free components / force scale
  double penetration = 0.0;      ///< max (Nu − ρ)⁺ / displacement scale
  double tension = 0.0;          ///< max (−λ_n)⁺ / pressure scale
  double complementarity = 0.0;  ///< contact and friction products / (pressure × displacement × area)
  double friction_cone = 0.0;    ///< max (|λ_t| − ψ)⁺ / pressure scale
  double force_balance = 0.0;    ///< |loads + contact + reactions| / force scale
  double duality_gap = 0.0;      ///< |primal − dual energy| / energy scale

  /// Returns the largest residual; infinity if one is NaN.
  double worst() const noexcept;
};

/// A residual and its name in result.json and messages.
struct NamedResidual {
  const char* name;
  double KktResiduals::*member;
};
inline constexpr std::array residual_names{NamedResidual{"equilibrium", &KktResiduals::equilibrium},
                                           NamedResidual{"penetration", &KktResiduals::penetration},
                                           NamedResidual{"tension", &KktResiduals::tension},
                                           NamedResidual{"complementarity", &KktResiduals::complementarity},
                                           NamedResidual{"friction_cone", &KktResiduals::friction_cone},
                                           NamedResidual{"force_balance", &KktResiduals::force_balance},
                                           NamedResidual{"duality_gap", &KktResiduals::duality_gap}};

/// KKT residuals with their rounding bounds. If both are small, the problem is solved (theory: kkt,
/// rounding).
struct Certificate : KktResiduals {
  /// Bound on the rounding error of each residual: its accuracy limit.
  KktResiduals rounding;

  /// Whether every residual plus its rounding bound is at most `tolerance`; then so is the true residual.
  bool meets(double tolerance) const noexcept;
  /// Whether all residuals above `tolerance` are at rounding level: further iterations do not change them.
  bool exhausted(double tolerance) const noexcept;
};

/// Lanczos estimate of the extreme eigenvalues of K = M^½ C B⁻¹ Cᵀ M^½, C = N or [N; T].
struct SpectrumResult {
  double lambda_min = 0.0, lambda_max = 0.0;
  double bound_min = 0.0, bound_max = 0.0;  ///< absolute error bounds (theory: lanczos-bounds)
  double r_star = 0.0;                      ///< theory: r-star
  bool converged = true;  ///< every solve and both Lanczos runs; otherwise λ and r* are rough
  int products = 0;       ///< products with K or K⁻¹, one solve per product
  std::int64_t cg_iterations = 0;
  std::uint64_t operator_applications = 0;
  double seconds = 0.0;
  bool friction = false;    ///< C = [N; T]
  std::int64_t traces = 0;  ///< rows of C
};

/// Summary of one completed load step.
struct LoadStep {
  double factor = 1.0;
  int outer_iterations = 0;        ///< of this load step
  std::int64_t cg_iterations = 0;  ///< likewise
  std::int64_t active_nodes = 0, slip_nodes = 0;
  Vector3 contact_force{}, friction_force{};
  double max_contact_pressure = 0.0;
  std::int64_t plastic_elements = 0;
  double worst_residual = 0.0;  ///< of the certificate, by the operator used in the loop
  std::vector<Vector3> probe;
  /// One per contact entry, 0 unless force-controlled; empty if no obstacle moves.
  std::vector<double> travel;
};

/// Estimated discretisation errors of the results (theory: error-estimate).
struct Discretisation {
  double energy = 0.0;  ///< error of the strains, relative in the energy norm
  /// Number of meshes, each with half the mesh width of the one before, behind the estimates below.
  int meshes = 1;
  std::vector<Vector3> probe;            ///< error of the displacement there; empty for one mesh
  std::optional<Vector3> contact_force;  ///< empty for one mesh, and without contact
};

/// Wall time of the phases of solve(), on this rank.
struct PhaseSeconds {
  double total = 0.0;
  double prepare = 0.0;               ///< operator and initial state
  double spectrum = 0.0;              ///< estimates for the first penalty
  double preconditioner_setup = 0.0;  ///< included in the other phases
  double solve = 0.0;                 ///< outer steps
  double checkpoint = 0.0;            ///< written during the run
  double certificate = 0.0;           ///< by the reference operator, and the totals
};

struct Result {
  Status status = Status::not_converged;
  std::string message;
  std::vector<std::string> warnings;  ///< why the numbers may be unreliable; one sentence each
  std::int64_t unknowns = 0, elements = 0;
  ElementType element = ElementType::tri3;
  std::int64_t contact_nodes = 0, active_nodes = 0, slip_nodes = 0;
  int outer_iterations = 0;
  int unsolved_steps = 0;    ///< of these, since a restart: steps with an unconverged linear solve
  int restarted_after = -1;  ///< outer steps before a restart, included in the counts; −1 without a restart
  std::int64_t contact_iterations = 0, cg_iterations = 0;
  std::uint64_t operator_applications = 0;  ///< for all purposes
  std::uint64_t spectrum_applications = 0;  ///< of these: for estimates of λ_min, λ_max, r_A
  /// Of these: solves inside the contact loop; the others are true residuals.
  std::uint64_t contact_applications = 0;
  std::vector<double> r;  ///< one per outer step
  double lambda_min = 0.0, lambda_max = 0.0, r_star = 0.0;
  /// Final r_n of ADMM, adapted to the contact set; 0 if only the first step used ADMM.
  double r_active = 0.0;
  Vector3 contact_force{}, friction_force{};  ///< forces of the obstacles on the body
  /// Coulomb: change of ψ in the last step / largest pressure; 0 without Coulomb friction.
  double bound_change = 0.0;
  double max_contact_pressure = 0.0, max_von_mises = 0.0;
  std::int64_t plastic_elements = 0;
  std::int64_t softening_elements = 0;   ///< in the softening range of a law with squared argument
  double plastic_share = 0.0;            ///< volume fraction of the elements beyond yield
  std::vector<ContactTotals> contact;    ///< one per contact entry
  std::vector<BoundaryTotals> reaction;  ///< one per displacement entry
  std::vector<BoundaryTotals> load;      ///< one per entry of another kind, times its factor at the end
  Extreme max_displacement;              ///< |u| at a node
  Extreme max_strain;                    ///< largest absolute principal strain at a quadrature point
  Extreme max_flow;      ///< norm of the strain deviator relative to that at yield; 0 if nothing yields
  Extreme max_rotation;  ///< infinitesimal rotation angle at a quadrature point, in radians
  Extreme max_von_mises_nodal;  ///< of recovered stress; filled in by the caller of recover_stress()
  BodySize body;
  Discretisation discretisation;  ///< filled in by the caller of estimate_error()
  std::vector<Vector3> probe;
  bool by_time = false;       ///< whether load factors are times of the load curves
  double load_reached = 0.0;  ///< factor of the last converged state; 0: none
  double load_factor = 1.0;   ///< factor of the state that all numbers and fields describe
  int load_cuts = 0;  ///< how often a load step, or part of one, was halved because it did not converge
  std::vector<LoadStep> load_steps;  ///< completed load steps; empty if the load is applied in one step
  Certificate certificate;
  PhaseSeconds seconds;
  int ranks = 1, threads = 1;
  std::string instruction_set;
};

/// State of a contact point.
enum class ContactStatus : std::uint8_t { open, stick, slip };  ///< frictionless contact: slip

/// This rank's fields, in the numbering of its Part. element_fields.hpp computes element fields from the
/// displacement.
struct Solution {
  Result result;                     ///< identical on every rank
  std::vector<double> displacement;  ///< nodes × dim
  /// Pressure subtracted from the stress because of temperature, as in ThermalPressure; empty: none.
  std::vector<double> thermal;
  std::vector<double> corner_dilatation;  ///< elements × 4: means of tr ε around their corners; empty if no
                                          ///< law needs them (theory: displacement-pressure)
  std::vector<double> gap;                ///< contact points: ρ − Nu, the open distance
  std::vector<double> pressure;           ///< contact points: λ_n
  std::vector<Vector3> traction;          ///< contact points: −λ_t, traction of the obstacle on the body
  std::vector<ContactStatus> contact_status;  ///< contact points
};

}  // namespace kacanov
