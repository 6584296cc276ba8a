// SPDX-License-Identifier: BSD-3-Clause
// Regions of like stiffness and the clusters that they form (theory: regions).
#pragma once

#include <vector>

#include "verify/problem.hpp"

namespace kacanov::verify {

struct Regions {
  /// A connected part of the body that is as stiff as `bin` or stiffer.
  struct Cluster {
    std::vector<bool> has;  ///< of each region
    int bin = 0;
    Vec centre{};
    Real radius = 0;
  };
  std::vector<int> bin;  ///< of each region: how many factors of ten it is softer than the stiffest
  std::vector<std::size_t> of_element;
  std::vector<std::size_t> of_node;  ///< the stiffest of a node's elements
  std::vector<Cluster> clusters;
};

Regions find_regions(const Problem& problem);

}  // namespace kacanov::verify
