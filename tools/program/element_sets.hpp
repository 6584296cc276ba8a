// SPDX-License-Identifier: BSD-3-Clause
// Which set of the mesh an element belongs to, for the fields of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/part.hpp>
#include "program/parallel.hpp"

namespace kacanov {

/// Set numbers of elements: 0 for none, else the place, from 1, in ElementSets::names. One for all where all
/// have the same; empty: the mesh has no sets of elements.
using SetNumbers = std::vector<std::uint16_t>;

struct ElementSets {
  std::vector<std::string> names;  ///< of groups of elements, in the mesh's order; 65,535 at the most
  SetNumbers of_element;           ///< of the whole mesh, one each; of several the first
};
ElementSets element_sets(const Mesh& mesh);

/// Those of a part's elements.
SetNumbers sets_of_part(const ElementSets& sets, const Part& part);

/// The same for every rank's part; `sets` are known to the first rank. Collective.
SetNumbers distribute_sets(const ElementSets& sets, const Part& part, const MpiSession& mpi);

}  // namespace kacanov
