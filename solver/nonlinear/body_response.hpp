// SPDX-License-Identifier: BSD-3-Clause
// Forces and energy of the body at a displacement, its secant or tangent, and what is known of both.
#pragma once

#include <span>
#include <vector>

#include "contact/certificate.hpp"
#include "linear/distributed_operator.hpp"
#include "linear/load_path.hpp"
#include "linear/space.hpp"

namespace kacanov {

/// Volume of each node of this rank, a share of those of its elements on all ranks; in 2D an area.
/// Collective.
Vector lumped_volume(const Part& part);

/// Throws InputError, on all ranks alike, where stiffnesses (`diagonal`: of the elastic B) or the forces that
/// loads and prescribed displacements come to lie beyond what the preconditioner's single precision holds.
/// Collective.
void refuse_beyond_floats(const Part& part, std::span<const float> diagonal);

/// R(u), the stored energy and the secant or tangent at the u it was last asked about. What takes a
/// displacement is collective; vectors are consistent over ranks.
class BodyResponse {
 public:
  /// At rest: elastic. `part` has to outlive it.
  BodyResponse(const Part& part, int threads, const std::string& instruction_set);

  /// What elements would be longer by, in plane stress (theory: expansion-in-plane); R(u) and the energy have
  /// what the load counts of it. Empty: by nothing.
  void set_free_strain(std::span<const double> of_element);
  /// R(u) and the energy; the operator stays what it is.
  void evaluate(std::span<const double> u);
  /// The same, and freezes the secant at u, in one pass.
  void evaluate_and_freeze(std::span<const double> u);
  /// The elastic force in place of R(u): where prescribed displacements put in at once look like huge strains
  /// in the first layer of elements.
  void take_elastic_force(std::span<const double> u);
  /// Freezes the elastic operator; whether it was another.
  bool freeze_elastic();
  /// Freezes the secant at u, if it is not.
  void freeze_secant(std::span<const double> u);
  /// Freezes the tangent at u, until forget_tangent().
  void freeze_tangent(std::span<const double> u);
  void forget_tangent() noexcept { op_.forget_tangent(); }

  /// The state that the operator is frozen at, for a checkpoint.
  struct Frozen {
    bool here = true;  ///< at the u of R(u)
    bool elastic = true;
  };
  Frozen frozen() const noexcept { return {current_, elastic_}; }
  /// Restores R(u), the energy and the frozen operator of the loop that returned `frozen`. Collective.
  void resume(std::span<const double> u, const Frozen& frozen);

  /// f = F − R(u).
  void unbalanced(const LoadPath& path, std::span<double> f) const;
  /// The same at any u; leaves R(u) and the operator as they are. Collective.
  void unbalanced(const LoadPath& path, std::span<const double> u, std::span<double> f);
  BodyForces forces(const LoadPath& path) const { return {path.load(), internal_, energy_, diagonal_}; }
  std::span<const double> internal() const noexcept { return internal_; }
  /// g as frozen: elements × points.
  Vector secant() const;
  /// Of the elastic B.
  std::span<const float> diagonal() const noexcept { return diagonal_; }
  /// All laws of this rank are linear: secant and tangent are the elastic operator.
  bool linear() const noexcept { return linear_; }

  DistributedOperator& op() noexcept { return op_; }
  const DistributedOperator& op() const noexcept { return op_; }

 private:
  /// Nothing moves and nothing pulls: R(u) is 0. Collective.
  bool at_rest(std::span<const double> u) const;

  const Part* part_;
  DistributedOperator op_;
  std::vector<float> diagonal_;
  Vector internal_;
  double energy_ = 0.0;
  bool linear_;
  bool stretched_ = false;  ///< some free strain is there
  bool elastic_ = true;     ///< the operator is
  bool current_ = true;     ///< the operator's g is that of the u of R(u)
};

/// To be called before `bytes` are allocated in a few pieces. The allocator keeps what is free (Open MPI
/// tells it to keep everything), but new pieces need not fit into old holes: before large ones the holes go
/// back to the system. Before small ones that costs more time than it is worth.
void make_room(std::size_t bytes);

}  // namespace kacanov
