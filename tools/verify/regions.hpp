// SPDX-License-Identifier: BSD-3-Clause
// Regions of similar stiffness and the clusters they form (theory: regions).
#pragma once

#include <vector>

#include "verify/problem.hpp"

namespace kacanov::verify {

struct Regions {
  /// A connected part of the body whose regions have a bin of at most `bin`.
  struct Cluster {
    std::vector<bool> has;  ///< one flag per region
    int bin = 0;
    Vec centre{};
    Real radius = 0;
  };
  std::vector<int> bin;  ///< of each region: decades by which it is softer than the stiffest
  std::vector<std::size_t> of_element;
  std::vector<std::size_t> of_node;  ///< region of the stiffest element at each node
  std::vector<Cluster> clusters;
};

Regions find_regions(const Problem& problem);

}  // namespace kacanov::verify
