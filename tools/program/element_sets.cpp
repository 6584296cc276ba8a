// SPDX-License-Identifier: BSD-3-Clause
// Element sets of the mesh, numbered for the fields of a run.
#include "program/element_sets.hpp"

#include <algorithm>
#include <limits>

#include "partition/part_fields.hpp"

namespace kacanov {
namespace {

SetNumbers pick_sets(const SetNumbers& all, const IndexRuns& elements) {
  SetNumbers some;
  if (all.empty()) return some;
  some.reserve(elements.size());
  for (std::size_t k = 0; k < elements.runs.size(); ++k) {
    const IndexRuns::Run& run = elements.runs[k];
    const std::int32_t end = k + 1 < elements.runs.size() ? elements.runs[k + 1].position : elements.count;
    const auto first = all.begin() + run.first;
    some.insert(some.end(), first, first + (end - run.position));
  }
  if (std::equal(some.begin() + (some.empty() ? 0 : 1), some.end(), some.begin())) some.resize(1);
  some.shrink_to_fit();
  return some;
}

}  // namespace

ElementSets element_sets(const Mesh& mesh) {
  ElementSets sets;
  for (const Group& group : mesh.groups) {
    if (group.dimension != mesh.dim() || sets.names.size() == std::numeric_limits<std::uint16_t>::max())
      continue;
    sets.of_element.resize(mesh.element_count(), 0);
    sets.names.push_back(group.name);
    for (const std::int32_t e : group.members)
      if (sets.of_element[e] == 0) sets.of_element[e] = static_cast<std::uint16_t>(sets.names.size());
  }
  return sets;
}

SetNumbers sets_of_part(const ElementSets& sets, const Part& part) {
  return pick_sets(sets.of_element, part.element_index);
}

SetNumbers distribute_sets(const ElementSets& sets, const Part& part, const MpiSession& mpi) {
  const MPI_Comm comm = mpi.comm();
  int some = sets.names.empty() ? 0 : 1;
  mpi.expect_all_here();
  MPI_Bcast(&some, 1, MPI_INT, 0, comm);
  if (some == 0) return {};
  if (mpi.first()) {
    for (int rank = 1; rank < mpi.ranks(); ++rank) {
      IndexRuns elements;
      std::uint64_t runs = 0;
      receive_bytes(&elements.count, sizeof elements.count, rank, comm);
      receive_bytes(&runs, sizeof runs, rank, comm);
      elements.runs.resize(runs);
      receive_bytes(elements.runs.data(), runs * sizeof(IndexRuns::Run), rank, comm);
      const SetNumbers picked = pick_sets(sets.of_element, elements);
      const std::uint64_t count = picked.size();
      send_bytes(&count, sizeof count, rank, comm);
      send_bytes(picked.data(), count * sizeof(std::uint16_t), rank, comm);
    }
    return sets_of_part(sets, part);
  }
  const IndexRuns& mine = part.element_index;
  std::uint64_t count = mine.runs.size();
  send_bytes(&mine.count, sizeof mine.count, 0, comm);
  send_bytes(&count, sizeof count, 0, comm);
  send_bytes(mine.runs.data(), count * sizeof(IndexRuns::Run), 0, comm);
  receive_bytes(&count, sizeof count, 0, comm);
  SetNumbers picked(count);
  receive_bytes(picked.data(), count * sizeof(std::uint16_t), 0, comm);
  return picked;
}

}  // namespace kacanov
