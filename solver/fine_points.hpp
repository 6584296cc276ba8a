// SPDX-License-Identifier: BSD-3-Clause
// The points of the finer rule, with what shape functions have there.
#pragma once

#include <vector>

#include <kacanov/cells.hpp>

namespace kacanov {

struct FinePoint {
  double weight = 0.0;
  std::vector<double> gradient;      ///< nodes × dim, along reference coordinates
  std::vector<double> value;         ///< nodes
  std::vector<double> corner_share;  ///< corners: of the straight cell
};

std::vector<FinePoint> fine_points(const Cell& type);

}  // namespace kacanov
