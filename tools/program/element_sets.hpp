// SPDX-License-Identifier: BSD-3-Clause
// Element sets of the mesh, numbered for the fields of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/part.hpp>
#include "program/parallel.hpp"

namespace kacanov {

/// Set number per element: 0 for none, else index + 1 into ElementSets::names. One entry if all elements have
/// the same; empty: the mesh has no element sets.
using SetNumbers = std::vector<std::uint16_t>;

struct ElementSets {
  std::vector<std::string> names;  ///< names of element groups in mesh order, at most 65,535
  SetNumbers of_element;           ///< per element of the whole mesh; the first of several sets
};
ElementSets element_sets(const Mesh& mesh);

/// Returns the set numbers of a part's elements.
SetNumbers sets_of_part(const ElementSets& sets, const Part& part);

/// Returns the set numbers of every rank's part; `sets` is used on the first rank. Collective.
SetNumbers distribute_sets(const ElementSets& sets, const Part& part, const MpiSession& mpi);

}  // namespace kacanov
