// SPDX-License-Identifier: BSD-3-Clause
// Which indices a rank owns, which it has copies of, and who has the others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/communicator.hpp>

namespace kacanov {

/// Local indices: the owned ones first, then ghosts, which other ranks own. Over all ranks the owned ones are
/// numbered one rank after the other.
struct IndexMap : Communicator {
  struct Neighbour {
    int rank = 0;
    std::vector<std::int32_t> shared;   ///< local indices both have, in an order both agree on
    std::vector<std::int32_t> send;     ///< owned here, ghosts there; likewise
    std::vector<std::int32_t> receive;  ///< owned there, ghosts here
  };
  std::int32_t owned = 0;
  std::vector<std::int64_t> starts = {
      0, 0};  ///< ranks + 1: the number of each rank's first owned index, and the total
  std::vector<std::int64_t> ghosts;   ///< their numbers
  std::vector<Neighbour> neighbours;  ///< ascending rank
  std::vector<std::int32_t> shared;   ///< every local index that another rank has too

  std::int64_t first() const noexcept { return starts[rank]; }
  std::int64_t total() const noexcept { return starts.back(); }
  /// Owned indices and ghosts.
  std::size_t size() const noexcept { return static_cast<std::size_t>(owned) + ghosts.size(); }
  /// Number of a local index over all ranks.
  std::int64_t number(std::size_t local) const noexcept {
    const std::size_t mine = owned;
    return local < mine ? first() + static_cast<std::int64_t>(local) : ghosts[local - mine];
  }
  /// Rank that owns a number.
  int owner(std::int64_t number) const noexcept;

  /// Overwrites ghosts with their owners' values (forward scatter). x: size() × components of double, float,
  /// std::int32_t or std::int64_t. Collective.
  template <class S>
  void forward(std::span<S> x, int components, CallSite at = CallSite()) const;
  /// Adds up what all ranks have for an index, in rank order, so that every copy ends with the same bits
  /// (reverse scatter). Collective.
  template <class S>
  void sum(std::span<S> x, int components, CallSite at = CallSite()) const;
  // Vectors are handed over as they are.
  template <class S>
  void forward(std::vector<S>& x, int components, CallSite at = CallSite()) const {
    forward(std::span<S>(x), components, at);
  }
  template <class S>
  void sum(std::vector<S>& x, int components, CallSite at = CallSite()) const {
    sum(std::span<S>(x), components, at);
  }
};

/// Numbers `owned` indices a rank one rank after the other. Collective.
std::vector<std::int64_t> number_owned(std::int64_t owned, const Communicator& comm,
                                       CallSite at = CallSite());

/// The map of `owned` indices here and of ghosts with these numbers, ascending: finds out who wants what. Its
/// neighbours have lists for forward scatters alone. Collective.
IndexMap make_index_map(const Communicator& comm, std::int32_t owned, std::vector<std::int64_t> ghosts,
                        CallSite at = CallSite());

}  // namespace kacanov
