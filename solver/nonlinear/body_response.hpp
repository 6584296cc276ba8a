// SPDX-License-Identifier: BSD-3-Clause
// Internal forces and energy of the body, and the frozen secant or tangent operator.
#pragma once

#include <span>
#include <vector>

#include "contact/certificate.hpp"
#include "linear/distributed_operator.hpp"
#include "linear/load_path.hpp"
#include "linear/space.hpp"

namespace kacanov {

/// Returns the lumped volume of each node of this rank, summed over the elements of all ranks; in 2D an area.
/// Collective.
Vector lumped_volume(const Part& part);

/// Throws InputError on all ranks if stiffnesses (`diagonal`: of the elastic B), or the forces of loads and
/// prescribed displacements, exceed the range of the preconditioner's single precision. Collective.
void refuse_beyond_floats(const Part& part, std::span<const float> diagonal);

/// R(u), the stored energy, and the operator, with secant or tangent, last frozen. Members that take a
/// displacement are collective; vectors are consistent over ranks.
class BodyResponse {
 public:
  /// Starts at rest with the elastic operator. `part` must outlive it.
  BodyResponse(const Part& part, int threads, const std::string& instruction_set);

  /// Sets the free strain of elements in plane stress (theory: expansion-in-plane); R(u) and the energy then
  /// include the thermal part of the load. Empty: none.
  void set_free_strain(std::span<const double> of_element);
  /// Computes R(u) and the energy; does not change the operator.
  void evaluate(std::span<const double> u);
  /// The same, and freezes the secant at u, in one pass.
  void evaluate_and_freeze(std::span<const double> u);
  /// Uses the elastic force instead of R(u): suddenly imposed displacements cause spurious large strains in
  /// the first layer of elements.
  void take_elastic_force(std::span<const double> u);
  /// Freezes the elastic operator; returns whether it was another one.
  bool freeze_elastic();
  /// Freezes the secant at u, unless it already is.
  void freeze_secant(std::span<const double> u);
  /// Freezes the tangent at u, until forget_tangent().
  void freeze_tangent(std::span<const double> u);
  void forget_tangent() noexcept { op_.forget_tangent(); }

  /// State at which the operator is frozen, for a checkpoint.
  struct Frozen {
    bool here = true;  ///< at the u of R(u)
    bool elastic = true;
  };
  Frozen frozen() const noexcept { return {current_, elastic_}; }
  /// Restores R(u), the energy and the operator of the loop whose frozen() is given. Collective.
  void resume(std::span<const double> u, const Frozen& frozen);

  /// f = F − R(u).
  void unbalanced(const LoadPath& path, std::span<double> f) const;
  /// The same at any u; R(u) and the operator do not change. Collective.
  void unbalanced(const LoadPath& path, std::span<const double> u, std::span<double> f);
  BodyForces forces(const LoadPath& path) const { return {path.load(), internal_, energy_, diagonal_}; }
  std::span<const double> internal() const noexcept { return internal_; }
  /// Returns the frozen g: elements × points.
  Vector secant() const;
  /// Diagonal of the elastic B.
  std::span<const float> diagonal() const noexcept { return diagonal_; }
  /// Whether all laws of this rank are linear: then secant and tangent are the elastic operator.
  bool linear() const noexcept { return linear_; }

  DistributedOperator& op() noexcept { return op_; }
  const DistributedOperator& op() const noexcept { return op_; }

 private:
  /// Whether u is zero and nothing acts, so that R(u) = 0. Collective.
  bool at_rest(std::span<const double> u) const;

  const Part* part_;
  DistributedOperator op_;
  std::vector<float> diagonal_;
  Vector internal_;
  double energy_ = 0.0;
  bool linear_;
  bool stretched_ = false;  ///< whether there is free strain
  bool elastic_ = true;     ///< whether the operator is the elastic one
  bool current_ = true;     ///< whether the operator's g is that at the u of R(u)
};

/// Call before allocating `bytes` in a few pieces. The allocator keeps freed memory (Open MPI disables
/// trimming), and new pieces may not fit into the holes, so free memory is returned to the system before
/// large allocations. For small ones this costs more time than it saves.
void make_room(std::size_t bytes);

}  // namespace kacanov
