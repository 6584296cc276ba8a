// SPDX-License-Identifier: BSD-3-Clause
// The assembled competitors: the same operator as a block CSR and as a CSR matrix.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/reference.hpp>

namespace kacanov::perf {

/// A block CSR matrix with dim × dim blocks stored by columns, and the CSR matrix made from it.
struct Matrices {
  int dim = 3;
  std::vector<std::int32_t> block_first, block_column;  ///< rows + 1; blocks
  std::vector<double> block;                            ///< blocks × dim²
  std::vector<std::int32_t> first, column;              ///< of the CSR matrix
  std::vector<double> value;

  /// Computes y = A x by blocks.
  void apply_blocks(std::span<const double> x, std::span<double> y, int threads) const;
  double bytes_of_blocks() const;
  double bytes_of_csr() const;
};

/// Assembles B(g) of the body from element matrices.
Matrices assemble(const Body& body, std::span<const double> g);

}  // namespace kacanov::perf
