// SPDX-License-Identifier: BSD-3-Clause
// Scatters between owners and ghosts in two halves, for what can be computed while messages travel.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <kacanov/index_map.hpp>

namespace kacanov {

/// IndexMap's scatters of vectors with the same number of components an index: start, compute, finish. Keeps
/// its buffers. S: double, float, std::int32_t, std::int64_t. One scatter at a time.
template <class S>
class Scatterer {
 public:
  /// The map has to outlive it.
  Scatterer(const IndexMap& map, int components);

  /// Sends owned values to the ranks that have ghosts of them.
  void start_forward(std::span<const S> x, CallSite at = CallSite());
  /// Overwrites the ghosts.
  void finish_forward(std::span<S> x);

  /// Sends x at the shared indices.
  void start_sum(std::span<const S> x, CallSite at = CallSite());
  /// Adds what the others sent, in rank order. x at the shared indices must be what it was at the start.
  void finish_sum(std::span<S> x);

 private:
  using List = std::vector<std::int32_t> IndexMap::Neighbour::*;
  void start(List outgoing, List incoming, std::span<const S> x, CallSite at);

  const IndexMap* map_;
  std::size_t width_;
  std::vector<S> send_, receive_, own_;
  std::unique_ptr<Messages> messages_;  ///< null where there is nobody to send to
};

extern template class Scatterer<double>;
extern template class Scatterer<float>;
extern template class Scatterer<std::int32_t>;
extern template class Scatterer<std::int64_t>;

}  // namespace kacanov
