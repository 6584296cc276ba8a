// SPDX-License-Identifier: BSD-3-Clause
// Split-phase scatters between owners and ghosts.
#include <kacanov/scatterer.hpp>

#include <algorithm>
#include <cstddef>

namespace kacanov {
namespace {

/// Copies x at `indices` to `to` and returns the end of the copy.
template <class S>
S* pack(std::span<const std::int32_t> indices, std::size_t width, std::span<const S> x, S* to) {
  for (const std::int32_t i : indices)
    for (std::size_t c = 0; c < width; ++c) *to++ = x[static_cast<std::size_t>(i) * width + c];
  return to;
}

}  // namespace

template <class S>
Scatterer<S>::Scatterer(const IndexMap& map, int components) : map_(&map), width_(components) {
  if (!map.neighbours.empty()) messages_ = map.transport->messages();
}

/// Starts a receive for each neighbour's `incoming` indices and a send of x at its `outgoing` indices.
template <class S>
void Scatterer<S>::start(List outgoing, List incoming, std::span<const S> x, CallSite at) {
  map_->expect_all_here(at, map_->total() * static_cast<std::int64_t>(width_));
  std::size_t out = 0, in = 0;
  for (const auto& n : map_->neighbours) {
    out += (n.*outgoing).size() * width_;
    in += (n.*incoming).size() * width_;
  }
  send_.resize(out);
  receive_.resize(in);
  S *to = send_.data(), *from = receive_.data();
  for (const auto& n : map_->neighbours) {
    const std::size_t count = (n.*incoming).size() * width_;
    if (count > 0) messages_->receive(from, count, sizeof(S), n.rank);
    from += count;
    S* const end = pack<S>(n.*outgoing, width_, x, to);
    if (end != to) messages_->send(to, end - to, sizeof(S), n.rank);
    to = end;
  }
}

template <class S>
void Scatterer<S>::start_forward(std::span<const S> x, CallSite at) {
  start(&IndexMap::Neighbour::send, &IndexMap::Neighbour::receive, x, at);
}

template <class S>
void Scatterer<S>::finish_forward(std::span<S> x) {
  if (messages_) messages_->wait();
  const S* from = receive_.data();
  for (const auto& n : map_->neighbours)
    for (const std::int32_t i : n.receive)
      for (std::size_t c = 0; c < width_; ++c) x[static_cast<std::size_t>(i) * width_ + c] = *from++;
}

template <class S>
void Scatterer<S>::start_sum(std::span<const S> x, CallSite at) {
  start(&IndexMap::Neighbour::shared, &IndexMap::Neighbour::shared, x, at);
}

template <class S>
void Scatterer<S>::finish_sum(std::span<S> x) {
  if (map_->neighbours.empty()) return;
  const auto& shared = map_->shared;
  own_.resize(shared.size() * width_);
  pack<S>(shared, width_, x, own_.data());
  for (const std::int32_t i : shared) std::fill_n(&x[static_cast<std::size_t>(i) * width_], width_, S{0});
  messages_->wait();
  const auto add = [&](std::span<const std::int32_t> indices, const S* from) {
    for (const std::int32_t i : indices)
      for (std::size_t c = 0; c < width_; ++c) x[static_cast<std::size_t>(i) * width_ + c] += *from++;
    return from;
  };
  const S* from = receive_.data();
  bool own_added = false;
  for (const auto& n : map_->neighbours) {
    if (!own_added && n.rank > map_->rank) {
      add(shared, own_.data());
      own_added = true;
    }
    from = add(n.shared, from);
  }
  if (!own_added) add(shared, own_.data());
}

template class Scatterer<double>;
template class Scatterer<float>;
template class Scatterer<std::int32_t>;
template class Scatterer<std::int64_t>;

}  // namespace kacanov
