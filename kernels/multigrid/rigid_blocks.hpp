// SPDX-License-Identifier: BSD-3-Clause
// Dense blocks of a rigid-motion level as Eigen matrices.
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
