// SPDX-License-Identifier: BSD-3-Clause
// The model in the terms of the case file, independent of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <kacanov/law.hpp>
#include <kacanov/mesh_view.hpp>
#include <kacanov/obstacle.hpp>

namespace kacanov {

/// The `on` key of an entry: selects facets (elements for a material or a body force).
struct Selector {
  enum class Kind { all, name, box };
  Kind kind = Kind::all;
  std::string name;          ///< Kind::name
  Vector3 lower{}, upper{};  ///< Kind::box, closed
};

struct MaterialEntry {
  Selector on;
  Law law;
  /// B-bar (theory: b-bar). Unset: as the law specifies, and also for plastic and nearly incompressible
  /// materials whose elements have a B-bar form and lock without it.
  std::optional<bool> bbar = {};
  /// Mixed: the pressure is a separate field, by B-bar or, for tet10, by means around the corners (theory:
  /// displacement-pressure). Unset: determined by `bbar`.
  enum class Formulation : std::uint8_t { displacement, mixed };
  std::optional<Formulation> formulation = {};
  double expansion = 0.0;  ///< linear thermal expansion: strain per temperature
};

/// Temperature above the strain-free one (theory: expansion): `value` at `point`, varying with the constant
/// `gradient`, or given at nodes.
struct Temperature {
  double value = 0.0;
  Vector3 gradient{}, point{};
  std::string nodes = {};  ///< if not empty, a name in Mesh::node_fields; the other members are then ignored

  Temperature() = default;
  Temperature(double everywhere) : value(everywhere) {}
  bool uniform() const { return nodes.empty() && gradient == Vector3{}; }
};

/// A support, load, spring or temperature. Exactly one of the optionals is set (`frame` goes with
/// `displacement`).
struct BoundaryEntry {
  Selector on;
  std::optional<std::array<std::optional<double>, 3>> displacement;  ///< nullopt: component is free
  std::optional<Vector3> traction;                                   ///< force per area
  std::optional<Vector3> total_force;        ///< distributed uniformly over the facets' area
  std::optional<double> pressure;            ///< acts against the outer normal
  std::optional<Vector3> body_force;         ///< force per volume
  std::string name = {};                     ///< see entry_name()
  std::optional<Vector3> spring = {};        ///< elastic bed: stiffness per area, per component
  std::optional<double> normal_spring = {};  ///< the same, along the facets' normals only
  std::optional<Vector3> node_spring = {};   ///< stiffness of each node
  std::optional<Vector3> node_force = {};    ///< on each node
  std::optional<double> normal = {};  ///< displacement along the outer normal of a flat group of facets
  /// Orthogonal axes, of any length, for the components of `displacement`; unset: the coordinate axes.
  std::optional<std::array<Vector3, 3>> frame = {};
  std::optional<Temperature> temperature = {};

  bool is_support() const noexcept { return displacement || normal; }
  bool is_spring() const noexcept { return spring || normal_spring || node_spring; }
};

struct Friction {
  /// Configuration from which slip is measured: the undeformed body, or the end of the previous load step
  /// (theory: slip-history).
  enum class Reference { start, step };
  double tresca = 0.0;   ///< bound ψ on |τ_t|, a stress
  double coulomb = 0.0;  ///< coefficient μ_f
  Reference reference = Reference::start;
};

/// A rigid motion of an obstacle over the load steps (theory: moving-obstacles), relative to its position in
/// the case file. Piecewise linear in time from rest at time 0; the obstacle stays in the last pose.
struct Motion {
  struct Pose {
    double time = 0.0;  ///< > 0, ascending: time of the load curves, or factor of the load steps
    Vector3 translation{};
    Vector3 rotation{};  ///< axis times angle in radians, counterclockwise, about `centre`
  };
  Vector3 centre{};
  std::vector<Pose> path;
};

/// An obstacle pushed by a force; it moves along `direction` until the contact force balances it (theory:
/// force-control).
struct ForceControl {
  double force = 0.0;   ///< > 0, force on the body along `direction`
  Vector3 direction{};  ///< towards the body, of any length
};

struct ContactEntry {
  Selector on;
  Obstacle obstacle;
  std::optional<Friction> friction;
  std::string name = {};  ///< see entry_name()
  std::optional<Motion> motion = {};
  /// Whether contact directions and gaps are recomputed at each load step from the displaced nodes.
  bool relinearise = false;
  std::optional<ForceControl> force_controlled = {};

  /// Whether normals or gaps change between load steps.
  bool moves() const noexcept { return motion || relinearise || force_controlled; }
};

/// Returns the name of an entry in results and messages: its own name, or its place, "boundary[1]",
/// "contact[0]".
std::string entry_name(const BoundaryEntry& entry, std::size_t index);
std::string entry_name(const ContactEntry& entry, std::size_t index);

/// Each field is a key of `solver` in the case file with the same name; `automatic` is spelled "auto" there.
struct SolverOptions {
  /// Linearisation: the secant (theory: kacanov), the tangent (theory: newton), or first the secant and then
  /// the tangent.
  enum class Outer { automatic, kacanov, newton };
  /// Contact algorithm: ADMM (theory: admm, dual-admm), or semismooth Newton (theory: active-set) after an
  /// ADMM step and with the method of multipliers as fallback (theory: augmented-newton).
  enum class Contact { automatic, admm, dual_admm, active_set };
  /// Penalty of ADMM: adapted during the run (theory: first-penalty, balance), r* (theory: r-star), the given
  /// `r`, or adapted by a published rule, for comparison (theory: penalty-rules).
  enum class Penalty { automatic, paper, fixed, residuals, relative_residuals, osqp, spectral };
  /// Stopping criterion: the KKT residuals (theory: kkt), or the size of a step (theory: step-stop).
  enum class Stop { kkt, paper };
  /// Rigid-body-mode multigrid (theory: multigrid), BoomerAMG (theory: elasticity-amg), or a sparse Cholesky
  /// factor for small bodies (theory: factorised).
  enum class Preconditioner { multigrid, elasticity, cholesky };

  double tolerance = 1e-6;  ///< relative tolerance of the `stop` criterion
  Outer outer = Outer::automatic;
  Contact contact = Contact::automatic;
  Penalty penalty = Penalty::automatic;  ///< the key is `r`
  /// Stress per length. With Penalty::fixed: the penalty; with one that adapts: the first one (the key is
  /// `first_r`), 0 for the solver's own.
  double r = 0.0;
  Stop stop = Stop::kkt;
  Preconditioner preconditioner = Preconditioner::multigrid;
  /// For aggregation multigrid: BoomerAMG replaces the first level with at most this many rows, and all
  /// coarser levels (theory: coarse-amg). 0: never.
  int coarse_amg = 0;
  int max_outer = 100;      ///< outer steps per load step
  int max_contact = 10000;  ///< contact iterations per outer step
  int max_cg = 2000;        ///< CG iterations per solve; a solve that reaches the limit has not converged
  double spectrum_tolerance = 1e-2;  ///< relative, on λ_min and λ_max
  /// Successive factors > 0 on loads, prescribed displacements and indentation (theory: load-path); the last
  /// is 1. Empty: the full load in one step.
  std::vector<double> load_steps;
  /// Whether coarser meshes, if available, are solved first (theory: nested).
  bool nested = true;
  /// Over-relaxation of ADMM, 1 ≤ α < 2 (theory: over-relaxation). Unset: 1 with Penalty::paper or
  /// Stop::paper, otherwise 1.7.
  std::optional<double> relaxation;
};

/// Whether the penalty changes during a run.
constexpr bool adapts(SolverOptions::Penalty penalty) {
  return penalty != SolverOptions::Penalty::fixed && penalty != SolverOptions::Penalty::paper;
}

/// A point of the load curves (theory: load-path). From its time on, the named entries have these factors on
/// their loads, prescribed displacements or indentation; factors are linear in time between two points.
struct LoadStage {
  double time = 0.0;                      ///< > 0, ascending
  std::map<std::string, double> factors;  ///< by entry_name() or place: "boundary[1]", "contact[0]"
};

struct Model {
  PlaneState plane = PlaneState::strain;  ///< of meshes in 2D
  double thickness = 1.0;                 ///< of plane strain and plane stress; all forces refer to it
  std::vector<MaterialEntry> materials;
  std::vector<BoundaryEntry> boundary;
  std::vector<ContactEntry> contact;
  /// One load step per point. Entries named in no point have the factor 1; the others have 0 until first
  /// named. Empty: all loads are scaled together by SolverOptions::load_steps.
  std::vector<LoadStage> steps;
  bool steps_are_factors = false;  ///< whether with_curves() created `steps` from SolverOptions::load_steps
  std::vector<Vector3> probes;
  SolverOptions solver;
};

/// Whether the obstacle of any entry changes between load steps, so that the model needs solve_moving().
bool any_moves(const Model& model);

/// Throw InputError for the first invalid value, with its path in the case file: "solver.tolerance: expected
/// a number above 0 and below 1, got 0". build_problem() checks everything that depends on the mesh.
/// validate(model) also validates the model's options.
void validate(const SolverOptions& options);
void validate(const Model& model);

/// A range of numbers; infinite bounds impose nothing.
struct NumberRule {
  static constexpr double none = std::numeric_limits<double>::infinity();
  const char* words;  ///< as in "solver.tolerance: expected a number above 0 and below 1, got 2"
  double above = -none, least = -none;  ///< requires > above and ≥ least
  double below = none, most = none;     ///< requires < below and ≤ most

  constexpr bool holds(double v) const noexcept { return v > above && v >= least && v < below && v <= most; }
};

/// Squares of larger numbers may overflow.
inline constexpr double largest_number = 1e100;

inline constexpr NumberRule any_number{.words = "a number"};
inline constexpr NumberRule positive{.words = "a number > 0", .above = 0.0};
inline constexpr NumberRule not_negative{.words = "a number ≥ 0", .least = 0.0};
inline constexpr NumberRule above_one{.words = "a number > 1", .above = 1.0};
inline constexpr NumberRule up_to_one{.words = "a number > 0 and ≤ 1", .above = 0.0, .most = 1.0};
inline constexpr NumberRule below_one{.words = "a number above 0 and below 1", .above = 0.0, .below = 1.0};
inline constexpr NumberRule poisson_ratio{
    .words = "a number above -1 and below 0.5", .above = -1.0, .below = 0.5};
inline constexpr NumberRule cone_angle{
    .words = "an angle in degrees above 0 and below 90", .above = 0.0, .below = 90.0};
inline constexpr NumberRule time_after_start{.words = "a time after 0", .above = 0.0};
/// With smaller factors, squared forces underflow in the preconditioner's single precision.
inline constexpr double smallest_factor = 1e-15;
inline constexpr NumberRule load_factor{.words = "a factor ≥ 1e-15", .least = smallest_factor};
inline constexpr NumberRule over_relaxation{.words = "a number ≥ 1 and below 2", .least = 1.0, .below = 2.0};
inline constexpr NumberRule penalty_number{.words = "\"auto\", \"paper\" or a number > 0", .above = 0.0};

/// Rule for a list of load steps.
inline constexpr const char* last_factor = "factors on the load of which the last is 1";

}  // namespace kacanov
