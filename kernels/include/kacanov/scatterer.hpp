// SPDX-License-Identifier: BSD-3-Clause
// Split-phase scatters between owners and ghosts, to overlap communication with computation.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>

namespace kacanov {

/// Scatters of an IndexMap for vectors with a fixed number of components per index: start, compute, finish.
/// Keeps its buffers. S: double, float, std::int32_t, std::int64_t. One scatter at a time.
template <class S>
class Scatterer {
 public:
  /// The map must outlive it.
  Scatterer(const IndexMap& map, int components);

  /// Sends owned values to the ranks that have ghosts of them.
  void start_forward(std::span<const S> x, CallSite at = CallSite());
  /// Overwrites the ghosts.
  void finish_forward(std::span<S> x);

  /// Sends x at the shared indices.
  void start_sum(std::span<const S> x, CallSite at = CallSite());
  /// Adds the values of the other ranks, in rank order. x at the shared indices must not change after the
  /// start.
  void finish_sum(std::span<S> x);

 private:
  using List = std::vector<std::int32_t> IndexMap::Neighbour::*;
  void start(List outgoing, List incoming, std::span<const S> x, CallSite at);

  const IndexMap* map_;
  std::size_t width_;
  std::vector<S> send_, receive_, own_;
  std::unique_ptr<Messages> messages_;  ///< null without neighbours
};

extern template class Scatterer<double>;
extern template class Scatterer<float>;
extern template class Scatterer<std::int32_t>;
extern template class Scatterer<std::int64_t>;

}  // namespace kacanov
