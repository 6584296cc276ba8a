// SPDX-License-Identifier: BSD-3-Clause
// Sums over nodes shared by several ranks, and copies from their owners.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kacanov {

/// Exchange plan over shared nodes. With one rank every call returns at once.
struct Halo {
  struct Neighbour {
    int rank = 0;
    std::vector<std::int32_t> shared;   ///< local nodes shared with it, in an order both agree on
    std::vector<std::int32_t> send;     ///< owned here, ghost there
    std::vector<std::int32_t> receive;  ///< owned there, ghost here
  };
  MPI_Comm comm = MPI_COMM_SELF;
  int rank = 0, ranks = 1;
  std::vector<Neighbour> neighbours;  ///< ascending rank
  std::vector<std::int32_t> shared;   ///< every local node that another rank has too

  /// Adds up the contributions of all ranks, in rank order so that every copy ends with the same bits.
  void sum(std::span<double> x, int components) const;
  void sum(std::span<float> x, int components) const;  ///< see also SharedSum
  /// Overwrites ghosts with their owners' values.
  void copy_from_owner(std::span<double> x, int components) const;
  void copy_from_owner(std::span<float> x, int components) const;

  double sum_all(double value) const;
  void sum_all(std::span<double> values) const;
  double max_all(double value) const;
  /// Whether it holds on some rank.
  bool any(bool here) const { return max_all(here ? 1.0 : 0.0) > 0.0; }
  std::int64_t sum_all(std::int64_t value) const;
};

/// Halo::sum in two halves, for what can be computed while messages travel. Keeps its buffers from one sum to
/// the next.
template <class S>
class SharedSum {
 public:
  /// The halo has to outlive it.
  SharedSum(const Halo& halo, int components);
  /// Sends x at the shared nodes.
  void start(std::span<const S> x);
  /// Adds what the others sent, in rank order. x at the shared nodes must be what it was at the start.
  void finish(std::span<S> x);

 private:
  const Halo* halo_;
  std::size_t width_;
  std::vector<S> send_, receive_, own_;
  std::vector<MPI_Request> requests_;
};

extern template class SharedSum<double>;
extern template class SharedSum<float>;

}  // namespace kacanov
