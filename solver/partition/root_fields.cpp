// SPDX-License-Identifier: BSD-3-Clause
// Gathers fields of the parts into fields of the whole problem on rank 0, and scatters them.
#include <algorithm>

#include <kacanov/checkpoint.hpp>
#include <kacanov/part.hpp>
#include "partition/part_fields.hpp"

namespace kacanov {
namespace {

using Index = std::int32_t;

/// Receives on rank 0 the list of another rank's entries.
std::vector<Index> receive_list(int rank, MPI_Comm comm) {
  std::size_t n = 0;
  receive_bytes(&n, sizeof n, rank, comm);
  std::vector<Index> list(n);
  receive_bytes(list.data(), n * sizeof(Index), rank, comm);
  return list;
}

void send_list(std::span<const Index> list, MPI_Comm comm) {
  const std::size_t n = list.size();
  send_bytes(&n, sizeof n, 0, comm);
  send_bytes(list.data(), n * sizeof(Index), 0, comm);
}

std::vector<double> gather(std::span<const Index> index, std::span<const double> local, std::size_t width,
                           std::size_t total, const Communicator& ranks) {
  if (ranks.rank > 0) {
    send_list(index, mpi_of(ranks));
    send_bytes(local.data(), index.size() * width * sizeof(double), 0, mpi_of(ranks));
    return {};
  }
  std::vector<double> all(total * width);
  const auto place = [&](std::span<const Index> where, std::span<const double> what) {
    for (std::size_t i = 0; i < where.size(); ++i)
      std::copy_n(&what[i * width], width, &all[static_cast<std::size_t>(where[i]) * width]);
  };
  place(index, local);
  for (int other = 1; other < ranks.ranks; ++other) {
    const std::vector<Index> where = receive_list(other, mpi_of(ranks));
    std::vector<double> what(where.size() * width);
    receive_bytes(what.data(), what.size() * sizeof(double), other, mpi_of(ranks));
    place(where, what);
  }
  return all;
}

std::vector<double> scatter(std::span<const Index> index, std::span<const double> all, std::size_t width,
                            const Communicator& ranks) {
  std::vector<double> mine(index.size() * width);
  if (ranks.rank > 0) {
    send_list(index, mpi_of(ranks));
    receive_bytes(mine.data(), mine.size() * sizeof(double), 0, mpi_of(ranks));
    return mine;
  }
  const auto pick = [&](std::span<const Index> where, std::vector<double>& values) {
    for (std::size_t i = 0; i < where.size(); ++i)
      std::copy_n(&all[static_cast<std::size_t>(where[i]) * width], width, &values[i * width]);
  };
  for (int other = 1; other < ranks.ranks; ++other) {
    const std::vector<Index> where = receive_list(other, mpi_of(ranks));
    std::vector<double> values(where.size() * width);
    pick(where, values);
    send_bytes(values.data(), values.size() * sizeof(double), other, mpi_of(ranks));
  }
  pick(index, mine);
  return mine;
}

std::vector<Index> elements_of(const Part& part) {
  std::vector<Index> index(part.element_count());
  for (std::size_t e = 0; e < index.size(); ++e) index[e] = part.element_index[e];
  return index;
}

std::size_t size_of(std::int64_t count) { return static_cast<std::size_t>(count); }

}  // namespace

std::vector<double> gather_nodal(const Part& part, std::span<const double> local, int components,
                                 CallSite at) {
  part.node_map.expect_all_here(at, components);
  return gather(std::span(part.node_index).first(size_of(part.owned_nodes())), local, size_of(components),
                size_of(part.total_nodes()), part.node_map);
}

std::vector<double> gather_contact(const Part& part, std::span<const double> local, int components,
                                   CallSite at) {
  part.node_map.expect_all_here(at, components);
  return gather(std::span(part.contact_index).first(size_of(part.owned_contact)), local, size_of(components),
                size_of(part.total_contact), part.node_map);
}

std::vector<double> scatter_nodal(const Part& part, std::span<const double> all, int components,
                                  CallSite at) {
  part.node_map.expect_all_here(at, components);
  return scatter(part.node_index, all, size_of(components), part.node_map);
}

std::vector<double> scatter_contact(const Part& part, std::span<const double> all, int components,
                                    CallSite at) {
  part.node_map.expect_all_here(at, components);
  return scatter(part.contact_index, all, size_of(components), part.node_map);
}

std::vector<double> gather_elements(const Part& part, std::span<const double> local, int each, CallSite at) {
  part.node_map.expect_all_here(at, each);
  return gather(elements_of(part), local, size_of(each), size_of(part.total_elements), part.node_map);
}

std::vector<double> scatter_elements(const Part& part, std::span<const double> all, int each, CallSite at) {
  part.node_map.expect_all_here(at, each);
  return scatter(elements_of(part), all, size_of(each), part.node_map);
}

}  // namespace kacanov
