// SPDX-License-Identifier: BSD-3-Clause
// Sums over nodes shared by several ranks, and copies from their owners.
#include <kacanov/halo.hpp>

#include <algorithm>
#include <cstddef>

namespace kacanov {
namespace {

MPI_Datatype type_of(double) { return MPI_DOUBLE; }
MPI_Datatype type_of(float) { return MPI_FLOAT; }

/// Copies x at `nodes` to `to` and returns where that ends.
template <class S>
S* pack(std::span<const std::int32_t> nodes, std::size_t width, std::span<const S> x, S* to) {
  for (const std::int32_t node : nodes)
    for (std::size_t c = 0; c < width; ++c) *to++ = x[static_cast<std::size_t>(node) * width + c];
  return to;
}

/// One of the lists of a neighbour.
using Nodes = std::vector<std::int32_t> Halo::Neighbour::*;

/// Starts a receive for each neighbour's `incoming` nodes, into `receive`, and a send of x at its `outgoing`
/// ones.
template <class S>
void start_exchange(const Halo& halo, std::size_t width, std::span<const S> x, Nodes outgoing, Nodes incoming,
                    std::vector<S>& send, std::vector<S>& receive, std::vector<MPI_Request>& requests) {
  std::size_t out = 0, in = 0;
  for (const auto& n : halo.neighbours) {
    out += (n.*outgoing).size() * width;
    in += (n.*incoming).size() * width;
  }
  send.resize(out);
  receive.resize(in);
  S *to = send.data(), *from = receive.data();
  for (const auto& n : halo.neighbours) {
    const auto count = static_cast<int>((n.*incoming).size() * width);
    if (count > 0) MPI_Irecv(from, count, type_of(S{}), n.rank, 0, halo.comm, &requests.emplace_back());
    from += count;
    S* const end = pack<S>(n.*outgoing, width, x, to);
    if (end != to)
      MPI_Isend(to, static_cast<int>(end - to), type_of(S{}), n.rank, 0, halo.comm, &requests.emplace_back());
    to = end;
  }
}

void wait_for(std::vector<MPI_Request>& requests) {
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  requests.clear();
}

template <class S>
void copy_shared(const Halo& halo, std::span<S> x, int components) {
  if (halo.neighbours.empty()) return;
  const auto width = static_cast<std::size_t>(components);
  std::vector<S> send, receive;
  std::vector<MPI_Request> requests;
  start_exchange<S>(halo, width, x, &Halo::Neighbour::send, &Halo::Neighbour::receive, send, receive,
                    requests);
  wait_for(requests);
  const S* from = receive.data();
  for (const auto& n : halo.neighbours)
    for (const std::int32_t node : n.receive)
      for (std::size_t c = 0; c < width; ++c) x[static_cast<std::size_t>(node) * width + c] = *from++;
}

template <class S>
void sum_shared(const Halo& halo, std::span<S> x, int components) {
  if (halo.neighbours.empty()) return;
  SharedSum<S> sum(halo, components);
  sum.start(x);
  sum.finish(x);
}

}  // namespace

template <class S>
SharedSum<S>::SharedSum(const Halo& halo, int components)
    : halo_(&halo), width_(static_cast<std::size_t>(components)) {}

template <class S>
void SharedSum<S>::start(std::span<const S> x) {
  constexpr Nodes shared = &Halo::Neighbour::shared;
  start_exchange(*halo_, width_, x, shared, shared, send_, receive_, requests_);
}

template <class S>
void SharedSum<S>::finish(std::span<S> x) {
  if (halo_->neighbours.empty()) return;
  const auto& shared = halo_->shared;
  own_.resize(shared.size() * width_);
  pack<S>(shared, width_, x, own_.data());
  for (const std::int32_t node : shared)
    std::fill_n(&x[static_cast<std::size_t>(node) * width_], width_, S{0});
  wait_for(requests_);
  const auto add = [&](std::span<const std::int32_t> nodes, const S* from) {
    for (const std::int32_t node : nodes)
      for (std::size_t c = 0; c < width_; ++c) x[static_cast<std::size_t>(node) * width_ + c] += *from++;
    return from;
  };
  const S* from = receive_.data();
  bool own_added = false;
  for (const auto& n : halo_->neighbours) {
    if (!own_added && n.rank > halo_->rank) {
      add(shared, own_.data());
      own_added = true;
    }
    from = add(n.shared, from);
  }
  if (!own_added) add(shared, own_.data());
}

template class SharedSum<double>;
template class SharedSum<float>;

void Halo::sum(std::span<double> x, int components) const { sum_shared(*this, x, components); }
void Halo::sum(std::span<float> x, int components) const { sum_shared(*this, x, components); }
void Halo::copy_from_owner(std::span<double> x, int components) const { copy_shared(*this, x, components); }
void Halo::copy_from_owner(std::span<float> x, int components) const { copy_shared(*this, x, components); }

double Halo::sum_all(double value) const {
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, comm);
  return value;
}

void Halo::sum_all(std::span<double> values) const {
  if (ranks > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, comm);
}

double Halo::max_all(double value) const {
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm);
  return value;
}

std::int64_t Halo::sum_all(std::int64_t value) const {
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, comm);
  return value;
}

}  // namespace kacanov
