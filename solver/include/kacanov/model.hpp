// SPDX-License-Identifier: BSD-3-Clause
// What is to be solved, in the terms of the case file, before it meets a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <kacanov/law.hpp>
#include <kacanov/mesh_view.hpp>
#include <kacanov/obstacle.hpp>

namespace kacanov {

/// The `on` of an entry: facets (elements for a material or a body force).
struct Selector {
  enum class Kind { all, name, box };
  Kind kind = Kind::all;
  std::string name;          ///< Kind::name
  Vector3 lower{}, upper{};  ///< Kind::box, closed
};

struct MaterialEntry {
  Selector on;
  Law law;
  /// B-bar (theory: b-bar). Unset: as the law has it, and wherever its elements have that form and lock
  /// without: in plastic and in nearly incompressible bodies.
  std::optional<bool> bbar = {};
  /// Mixed: the pressure is a field of its own, by B-bar or, in tet10, by means round the corners (theory:
  /// displacement-pressure). Unset: as `bbar` says.
  enum class Formulation : std::uint8_t { displacement, mixed };
  std::optional<Formulation> formulation = {};
  double expansion = 0.0;  ///< linear thermal expansion: a strain over a temperature
};

/// By how much elements are warmer than where they are free of strain (theory: expansion): `value` at
/// `point`, changing by `gradient` from there, or numbers at nodes.
struct Temperature {
  double value = 0.0;
  Vector3 gradient{}, point{};
  std::string nodes = {};  ///< not empty: a name among Mesh::node_fields, and the others say nothing

  Temperature() = default;
  Temperature(double everywhere) : value(everywhere) {}
  bool uniform() const { return nodes.empty() && gradient == Vector3{}; }
};

/// Exactly one of the optionals is set.
struct BoundaryEntry {
  Selector on;
  std::optional<std::array<std::optional<double>, 3>> displacement;  ///< nullopt: component is free
  std::optional<Vector3> traction;                                   ///< force an area
  std::optional<Vector3> total_force;                                ///< spread evenly over the facets' area
  std::optional<double> pressure;                                    ///< against the outer normal
  std::optional<Vector3> body_force;                                 ///< force a volume
  std::string name = {};                                             ///< see entry_name()
  std::optional<Vector3> spring = {};        ///< elastic bed: stiffness an area, of each component
  std::optional<double> normal_spring = {};  ///< the same along the facets' normals alone
  std::optional<Vector3> node_spring = {};   ///< stiffness of each node
  std::optional<Vector3> node_force = {};    ///< on each node
  std::optional<double> normal = {};  ///< displacement along the outer normal of a flat group of facets
  /// Axes, orthogonal, of any length, that `displacement` is told along; unset: those of the coordinates.
  std::optional<std::array<Vector3, 3>> frame = {};
  std::optional<Temperature> temperature = {};

  bool is_support() const noexcept { return displacement || normal; }
  bool is_spring() const noexcept { return spring || normal_spring || node_spring; }
};

struct Friction {
  /// What slip is counted from: the undeformed body, or the end of the load step before (theory:
  /// slip-history).
  enum class Reference { start, step };
  double tresca = 0.0;   ///< bound psi on |tau_t|, a stress
  double coulomb = 0.0;  ///< coefficient mu_f
  Reference reference = Reference::start;
};

/// A rigid motion of an obstacle along the load steps (theory: moving-obstacles): where it has been taken to
/// from where the case has it. Linear in between, from rest at the time 0 on; it stays in the last place.
struct Motion {
  struct Pose {
    double time = 0.0;  ///< > 0, ascending: of load curves, or the factor of load steps
    Vector3 translation{};
    Vector3 rotation{};  ///< axis times angle in radians, counterclockwise, about `centre`
  };
  Vector3 centre{};
  std::vector<Pose> path;
};

/// An obstacle that is pushed, and moves along `direction` as far as it takes (theory: force-control).
struct ForceControl {
  double force = 0.0;   ///< > 0, that it does to the body along `direction`
  Vector3 direction{};  ///< towards the body, any length
};

struct ContactEntry {
  Selector on;
  Obstacle obstacle;
  std::optional<Friction> friction;
  std::string name = {};  ///< see entry_name()
  std::optional<Motion> motion = {};
  /// Whether nodes face the obstacle anew at each load step, from where the step before has left them.
  bool relinearise = false;
  std::optional<ForceControl> force_controlled = {};

  /// Whether how the nodes face it differs from load step to load step.
  bool moves() const noexcept { return motion || relinearise || force_controlled; }
};

/// What results and messages call an entry: its own name, or its place, "boundary[1]", "contact[0]".
std::string entry_name(const BoundaryEntry& entry, std::size_t index);
std::string entry_name(const ContactEntry& entry, std::size_t index);

/// Every field is a key of the case file's `solver`, with the same name; `automatic` is "auto" there.
struct SolverOptions {
  /// Linearisation: the secant (theory: kacanov), the tangent (theory: newton), or the one and then the
  /// other.
  enum class Outer { automatic, kacanov, newton };
  /// Contact: ADMM (theory: admm, dual-admm), semismooth Newton (theory: active-set), or that with ADMM to
  /// begin with and to fall back on.
  enum class Contact { automatic, admm, dual_admm, active_set };
  /// The penalty of ADMM: balanced as it goes (theory: first-penalty, balance), r* (theory: r-star), or `r`.
  enum class Penalty { automatic, paper, fixed };
  /// What ends a run: the KKT residuals (theory: kkt), or the size of a step (theory: step-stop).
  enum class Stop { kkt, paper };
  /// Rigid-body-mode multigrid (theory: multigrid) or BoomerAMG (theory: elasticity-amg).
  enum class Preconditioner { multigrid, elasticity };

  double tolerance = 1e-6;  ///< relative, on what `stop` looks at
  Outer outer = Outer::automatic;
  Contact contact = Contact::automatic;
  Penalty penalty = Penalty::automatic;  ///< the key is `r`
  double r = 0.0;                        ///< with Penalty::fixed, > 0: stress over length
  Stop stop = Stop::kkt;
  Preconditioner preconditioner = Preconditioner::multigrid;
  /// With the multigrid over aggregates: the first level of at most so many goes to BoomerAMG with all below
  /// (theory: coarse-amg). 0: none does.
  int coarse_amg = 0;
  int max_outer = 100;               ///< outer steps of a load step
  int max_contact = 10000;           ///< contact iterations within an outer step
  int max_cg = 2000;                 ///< CG iterations of one solve; what takes more has not converged
  double spectrum_tolerance = 1e-2;  ///< relative, on λ_min and λ_max
  /// Factors > 0 on loads, prescribed displacements and indentation, one after the other (theory: load-path);
  /// the last is 1. Empty: at once.
  std::vector<double> load_steps;
  /// Whether coarser meshes are solved first where there are some (theory: nested).
  bool nested = true;
  /// Of ADMM, 1 ≤ α < 2 (theory: over-relaxation). Unset: 1 with Penalty::paper or Stop::paper, else 1.7.
  std::optional<double> relaxation;
};

/// A point of the load curves (theory: load-path): from here on the entries that are named have these
/// factors, on loads, prescribed displacements or indentation; between two points they change linearly with
/// time.
struct LoadStage {
  double time = 0.0;                      ///< > 0, ascending
  std::map<std::string, double> factors;  ///< by entry_name() or place: "boundary[1]", "contact[0]"
};

struct Model {
  PlaneState plane = PlaneState::strain;  ///< of meshes in 2D
  double thickness = 1.0;                 ///< of plane strain and plane stress: what all forces are of
  std::vector<MaterialEntry> materials;
  std::vector<BoundaryEntry> boundary;
  std::vector<ContactEntry> contact;
  /// One load step each. Entries that none names have the factor 1, others 0 until they are named. Empty: all
  /// loads go together, by SolverOptions::load_steps.
  std::vector<LoadStage> steps;
  bool steps_are_factors = false;  ///< with_curves() has made `steps` of SolverOptions::load_steps
  std::vector<Vector3> probes;
  SolverOptions solver;
};

/// Whether an obstacle differs from load step to load step, so that solve_moving() is what the model needs.
bool any_moves(const Model& model);

/// Throw InputError about the first thing that makes no sense, in the words and with the paths of the case
/// file: "solver.tolerance: expected a number above 0 and below 1, got 0". What only a mesh can tell,
/// build_problem() says. The options of a model are validated with it.
void validate(const SolverOptions& options);
void validate(const Model& model);

}  // namespace kacanov
