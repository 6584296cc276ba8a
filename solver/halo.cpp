// SPDX-License-Identifier: BSD-3-Clause
// Sums over nodes shared by several ranks, and copies from their owners.
#include "halo.hpp"

#include <cstddef>

namespace kacanov {
namespace {

MPI_Datatype type_of(double) { return MPI_DOUBLE; }
MPI_Datatype type_of(float) { return MPI_FLOAT; }

/// Starts one receive and one send a neighbour and waits for all. Buffers are sized by the lists.
template <class S>
class Exchange {
 public:
  Exchange(const Halo& halo, int components, bool owner_to_ghost)
      : halo_(halo), width_(static_cast<std::size_t>(components)) {
    std::size_t out = 0, in = 0;
    for (const auto& n : halo.neighbours) {
      out += (owner_to_ghost ? n.send : n.shared).size();
      in += (owner_to_ghost ? n.receive : n.shared).size();
    }
    send_.resize(out * width_);
    receive_.resize(in * width_);
    requests_.reserve(2 * halo.neighbours.size());
  }

  void post(std::span<const S> x, bool owner_to_ghost) {
    std::size_t in = 0, out = 0;
    for (const auto& n : halo_.neighbours) {
      const auto& receive_list = owner_to_ghost ? n.receive : n.shared;
      const auto& send_list = owner_to_ghost ? n.send : n.shared;
      const std::size_t in_count = receive_list.size() * width_, out_count = send_list.size() * width_;
      MPI_Request request;
      if (in_count > 0) {
        MPI_Irecv(receive_.data() + in, static_cast<int>(in_count), type_of(S{}), n.rank, 0, halo_.comm, &request);
        requests_.push_back(request);
      }
      S* to = send_.data() + out;
      for (const std::int32_t node : send_list)
        for (std::size_t c = 0; c < width_; ++c) *to++ = x[static_cast<std::size_t>(node) * width_ + c];
      if (out_count > 0) {
        MPI_Isend(send_.data() + out, static_cast<int>(out_count), type_of(S{}), n.rank, 0, halo_.comm, &request);
        requests_.push_back(request);
      }
      in += in_count;
      out += out_count;
    }
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  }

  const S* received() const noexcept { return receive_.data(); }

 private:
  const Halo& halo_;
  std::size_t width_;
  std::vector<S> send_, receive_;
  std::vector<MPI_Request> requests_;
};

template <class S>
void sum_shared(const Halo& halo, std::span<S> x, int components) {
  const auto& neighbours = halo.neighbours;
  const auto& shared = halo.shared;
  const int rank = halo.rank;
  if (neighbours.empty()) return;
  const auto width = static_cast<std::size_t>(components);
  Exchange<S> exchange(halo, components, false);
  exchange.post(x, false);

  std::vector<S> own(shared.size() * width);
  for (std::size_t i = 0; i < shared.size(); ++i)
    for (std::size_t c = 0; c < width; ++c) {
      S& entry = x[static_cast<std::size_t>(shared[i]) * width + c];
      own[i * width + c] = entry;
      entry = 0.0;
    }
  const auto add_own = [&] {
    for (std::size_t i = 0; i < shared.size(); ++i)
      for (std::size_t c = 0; c < width; ++c)
        x[static_cast<std::size_t>(shared[i]) * width + c] += own[i * width + c];
  };
  const S* from = exchange.received();
  bool own_added = false;
  for (const auto& n : neighbours) {
    if (!own_added && n.rank > rank) {
      add_own();
      own_added = true;
    }
    for (const std::int32_t node : n.shared)
      for (std::size_t c = 0; c < width; ++c) x[static_cast<std::size_t>(node) * width + c] += *from++;
  }
  if (!own_added) add_own();
}

template <class S>
void copy_shared(const Halo& halo, std::span<S> x, int components) {
  const auto& neighbours = halo.neighbours;
  if (neighbours.empty()) return;
  const auto width = static_cast<std::size_t>(components);
  Exchange<S> exchange(halo, components, true);
  exchange.post(x, true);
  const S* from = exchange.received();
  for (const auto& n : neighbours)
    for (const std::int32_t node : n.receive)
      for (std::size_t c = 0; c < width; ++c) x[static_cast<std::size_t>(node) * width + c] = *from++;
}

}  // namespace

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
