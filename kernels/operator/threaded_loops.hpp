// SPDX-License-Identifier: BSD-3-Clause
// The operator's data, and its loops over blocks: a share of the blocks per thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include <kacanov/operator.hpp>
#include "operator/layout.hpp"
#include "operator/nodal_pressure.hpp"
#include "simd/instruction_set.hpp"

namespace kacanov {

template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) noexcept {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* p, std::size_t) noexcept { ::operator delete(p, line); }
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const noexcept {
    return true;
  }
};

template <class T>
using Aligned = std::vector<T, CacheLineAllocator<T>>;

/// Vectors are nodes × dim in the caller's numbering. Nothing is checked here: see checks.hpp and
/// operator.cpp.
template <class Real>
struct BasicOperator<Real>::Data {
  struct Scratch {
    Aligned<Real> u, f;      ///< records of the current block, for up to four input vectors
    std::vector<Real> sums;  ///< private sums on the interface, three values per slot
  };
  struct Machine {
    simd::InstructionSet set;
    const simd::Kernels<Real>& kernels;
    int threads;
  };
  struct MeshFacts {
    ElementType type;
    PlaneState plane;
    std::size_t unknowns, points;
  };
  struct Materials {
    std::vector<Law> laws;
    std::vector<simd::LawView> views;
  };
  /// Numbers per slot; all but `secant` may be empty.
  struct SlotValues {
    Aligned<Real> secant, free_strain;
    Aligned<Real> strain, outside_secant, outside_slope, outside_energy;  ///< for laws of the caller's own
  };
  struct Tangent {
    bool present = false;
    Aligned<float> floats;
    Aligned<Real> secant;  ///< g of the tangent if it differs from that of the operator
  };
  /// The averages of tr ε around corners, by entry; `change` and `mean` per vector.
  struct NodalPressure {
    CornerLayout corners;
    std::vector<double> bulk, volume;          ///< volume: of this process
    std::vector<Real> weight, change, mean;    ///< weight: 1 / volume of all processes; change: by place
    std::function<void(std::span<Real>)> sum;  ///< over processes; null with one process
  };
  struct Workspace {
    std::vector<Scratch> of_thread;
    int vectors = 0;  ///< for which the records have room
  };
  /// `count` vectors of the caller, one after another in x and y; either may be null.
  struct CallerVectors {
    const Real* x;
    Real* y;
    int count = 1;
  };

  /// `like`: layout of a double-precision operator of the same mesh, whose partitioning is reused; null:
  /// none.
  Data(const Body& body, const OperatorOptions& options, const Layout* like);
  // Not copyable: the views of the laws point into it.
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  static Machine machine_of(const OperatorOptions& options);
  std::size_t dim() const { return dimension(mesh.type); }
  /// The bulk modulus for in-plane strains.
  double bulk_at(const Law& law, double g) const;
  simd::Block<Real> block(std::size_t b);
  void reserve_scratch(int count);
  /// Must be called before g changes: a frozen tangent keeps its g.
  void detach_tangent();

  /// y_v = B x_v for `count` vectors (1, 2 or 4), one after another in x and y. Returns Σ x_vᵀ y_v if
  /// `with_dot`, else 0.
  double apply(const Real* x, Real* y, int count, bool with_dot,
               const OnInterfaceReady& on_interface_ready = {});
  double apply_tangent(const Real* x, Real* y, int count, bool with_dot,
                       const OnInterfaceReady& on_interface_ready = {});
  /// Σ x_vᵀ y_v over the block.
  double dots(const simd::Block<Real>& at, const simd::Vectors<Real>& vectors);
  /// Internal force at u into f, unless that is null; `keep` selects the outputs. Returns the energy if it is
  /// summed.
  double nonlinear(const Real* u, Real* f, const simd::Nonlinear& keep,
                   const simd::Outside<Real>& outside = {});
  /// Copies caller values (elements × points) to slots, with 0 in idle lanes; null if `of_point` is empty.
  const Real* by_slot(std::span<const double> of_point, Aligned<Real>& slots) const;

  /// Whether this or another process averages tr ε around corners. Collective operations depend on this, not
  /// on the entries of this process.
  bool averages() const { return nodal.corners.entries > 0 || nodal.sum; }
  /// nodal.change = ∫ N tr ε(x_v) around the corners, the contribution of this process, at the places of the
  /// entries.
  void find_changes(const Real* x, int count);
  /// y = A x (theory: displacement-pressure).
  void apply_deviator(const Real* x, Real* y, const OnInterfaceReady& on_interface_ready);
  /// y = A x + Bᵀ p, or Bᵀ p if x is null (theory: displacement-pressure).
  void apply_pressure(const Real* x, const Real* p, Real* y, const OnInterfaceReady& on_interface_ready);
  /// Computes the averages of tr ε(x_v) around the corners over all processes into `nodal.mean`. Returns this
  /// process's part of the energy that k0 stores in those of the first vector.
  double find_means(const Real* x, int count);
  /// Computes `nodal.weight` from the volumes of all processes.
  void weigh_corners();

  /// Calls loops(block, u, f, stride) between gathering x and scattering y, and sums its return values.
  /// `averaged`: find_means() has computed the averages of x. If x is null, the records of u hold only
  /// averages.
  template <class LoopsOnBlock>
  double loop(const CallerVectors& vectors, bool averaged, const OnInterfaceReady& on_interface_ready,
              LoopsOnBlock&& loops);
  void add_interface(Real* y, int count, std::size_t begin, std::size_t end);

  template <class E, class Visit>
  void visit_elements(const BlockRange& range, const simd::Group& group, std::span<const char> wanted,
                      const Visit& visit) const;
  template <class Add>
  void sum_blocks(std::span<Real> blocks, std::span<const char> wanted, const Add& add) const;
  template <class Bulk>
  void sum_secant_blocks(std::span<Real> blocks, std::span<const char> wanted, const Bulk& bulk) const;

  Machine machine;
  MeshFacts mesh;
  Materials materials;
  Layout layout;
  Aligned<Real> coordinates;
  SlotValues values;
  Tangent tangent;
  NodalPressure nodal;
  Workspace workspace;
  std::uint64_t applications = 0;
};

}  // namespace kacanov
