// SPDX-License-Identifier: BSD-3-Clause
// Index map: the indices that a rank owns, its ghosts, and their owners.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/communicator.hpp>

namespace kacanov {

/// Local indices: owned ones first, then ghosts, which other ranks own. Global numbers of owned indices are
/// contiguous per rank, in rank order.
struct IndexMap : Communicator {
  struct Neighbour {
    int rank = 0;
    std::vector<std::int32_t> shared;   ///< local indices on both ranks, in the same order on both
    std::vector<std::int32_t> send;     ///< owned here, ghosts there; same order on both
    std::vector<std::int32_t> receive;  ///< owned there, ghosts here
  };
  std::int32_t owned = 0;
  std::vector<std::int64_t> starts = {
      0, 0};  ///< size ranks + 1: first owned global number of each rank, then the total
  std::vector<std::int64_t> ghosts;   ///< their global numbers
  std::vector<Neighbour> neighbours;  ///< ascending rank
  std::vector<std::int32_t> shared;   ///< all local indices that also exist on another rank

  std::int64_t first() const noexcept { return starts[rank]; }
  std::int64_t total() const noexcept { return starts.back(); }
  /// Number of owned indices and ghosts.
  std::size_t size() const noexcept { return static_cast<std::size_t>(owned) + ghosts.size(); }
  /// Global number of a local index.
  std::int64_t number(std::size_t local) const noexcept {
    const std::size_t mine = owned;
    return local < mine ? first() + static_cast<std::int64_t>(local) : ghosts[local - mine];
  }
  /// Rank that owns a global number.
  int owner(std::int64_t number) const noexcept;

  /// Overwrites ghosts with their owners' values (forward scatter). x: size() × components of double, float,
  /// std::int32_t or std::int64_t. Collective.
  template <class S>
  void forward(std::span<S> x, int components, CallSite at = CallSite()) const;
  /// Sums the values of an index over all ranks, in rank order, so that every copy gets the same bits
  /// (reverse scatter). Collective.
  template <class S>
  void sum(std::span<S> x, int components, CallSite at = CallSite()) const;
  // Overloads for std::vector.
  template <class S>
  void forward(std::vector<S>& x, int components, CallSite at = CallSite()) const {
    forward(std::span<S>(x), components, at);
  }
  template <class S>
  void sum(std::vector<S>& x, int components, CallSite at = CallSite()) const {
    sum(std::span<S>(x), components, at);
  }
};

/// Numbers the owned indices of all ranks, `owned` on this one, rank by rank. Returns IndexMap::starts.
/// Collective.
std::vector<std::int64_t> number_owned(std::int64_t owned, const Communicator& comm,
                                       CallSite at = CallSite());

/// Index map of `owned` indices on this rank and ghosts with these global numbers, ascending. It finds out
/// which ranks need which indices. The neighbours have lists for forward scatters only. Collective.
IndexMap make_index_map(const Communicator& comm, std::int32_t owned, std::vector<std::int64_t> ghosts,
                        CallSite at = CallSite());

}  // namespace kacanov
