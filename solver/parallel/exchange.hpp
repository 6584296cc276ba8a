// SPDX-License-Identifier: BSD-3-Clause
// Entries from every rank to every rank.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include <kacanov/communicator.hpp>

namespace kacanov {

/// What came, in the order of the ranks.
template <class T>
struct Received {
  std::vector<T> entries;
  std::vector<int> starts;  ///< ranks + 1
  std::span<const T> from(std::size_t rank) const {
    return std::span(entries).subspan(starts[rank], starts[rank + 1] - starts[rank]);
  }
};

/// Sends to[r] to rank r: plain structs and numbers. Collective.
template <class T>
Received<T> exchange_all(const std::vector<std::vector<T>>& to, const Communicator& comm) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t ranks = to.size();
  std::vector<int> out(ranks), in(ranks), out_at(ranks, 0);
  std::vector<T> sent;
  for (std::size_t r = 0; r < ranks; ++r) {
    out[r] = static_cast<int>(to[r].size());
    sent.insert(sent.end(), to[r].begin(), to[r].end());
  }
  MPI_Alltoall(out.data(), 1, MPI_INT, in.data(), 1, MPI_INT, comm.comm);
  std::exclusive_scan(out.begin(), out.end(), out_at.begin(), 0);
  Received<T> received;
  received.starts.assign(ranks + 1, 0);
  std::partial_sum(in.begin(), in.end(), received.starts.begin() + 1);
  received.entries.resize(received.starts.back());
  MPI_Datatype type;
  MPI_Type_contiguous(static_cast<int>(sizeof(T)), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Alltoallv(sent.data(), out.data(), out_at.data(), type, received.entries.data(), in.data(),
                received.starts.data(), type, comm.comm);
  MPI_Type_free(&type);
  return received;
}

/// The entries of all ranks on every rank, in the order of the ranks. Collective.
template <class T>
std::vector<T> gathered(const std::vector<T>& mine, const Communicator& comm) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (comm.ranks == 1) return mine;
  std::vector<int> count(comm.ranks), first(count.size());
  const auto here = static_cast<int>(mine.size());
  MPI_Allgather(&here, 1, MPI_INT, count.data(), 1, MPI_INT, comm.comm);
  std::exclusive_scan(count.begin(), count.end(), first.begin(), 0);
  std::vector<T> all(first.back() + count.back());
  MPI_Datatype type;
  MPI_Type_contiguous(static_cast<int>(sizeof(T)), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Allgatherv(mine.data(), here, type, all.data(), count.data(), first.data(), type, comm.comm);
  MPI_Type_free(&type);
  return all;
}

}  // namespace kacanov
