// SPDX-License-Identifier: BSD-3-Clause
// The dense blocks of a level of the hierarchy as Eigen's matrices.
#pragma once

#include <Eigen/Dense>

#include "multigrid/rigid_level.hpp"

namespace kacanov {

template <int M>
using Dense = Eigen::Matrix<double, M, M, Eigen::RowMajor>;

template <int M>
Dense<M> dense(const typename BlockSums<M>::Block& block) {
  return Eigen::Map<const Dense<M>>(block.data());
}

}  // namespace kacanov
