// SPDX-License-Identifier: BSD-3-Clause
// The C handle of a solved case and its arrays.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include <kacanov/kacanov_solve.h>
#include "program/solve_case.hpp"

namespace kacanov::embedding {

/// Element means, computed at the first request.
struct ElementArrays {
  std::vector<double> stress, von_mises, dev_strain, secant;
  std::vector<std::int32_t> plastic;
};

/// Arrays of the contact points in the layout of the C interface.
struct ContactArrays {
  std::vector<std::int32_t> node, entry, status;
  std::vector<double> normal;
};

}  // namespace kacanov::embedding

/// All arrays are on the first rank; other ranks have only the result and its JSON.
struct kacanov_solution {
  kacanov::SolvedCase solved;
  std::string json;
  kacanov::embedding::ContactArrays contact;
  std::vector<std::int64_t> node_numbers, element_numbers;
  mutable std::once_flag elements_made;
  mutable kacanov::embedding::ElementArrays elements;

  explicit kacanov_solution(kacanov::SolvedCase of);
};
