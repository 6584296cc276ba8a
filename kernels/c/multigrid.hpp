// SPDX-License-Identifier: BSD-3-Clause
// The handle of a multigrid.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "c/handle.hpp"
#include "multigrid/multigrid.hpp"

/// A multigrid's copies of an operator's data, so that the operator may get other laws. Coordinates and
/// connectivity are the operator's unless some nodes belong to no element: these are left out.
struct kacanov_multigrid {
  kacanov_operator* op = nullptr;  ///< shared with the caller
  kacanov::MultigridOptions options;
  std::vector<std::int32_t>
      used;  ///< nodes with elements, if some nodes have none; the multigrid contains only these
  std::vector<std::int32_t> number;  ///< number of each node among them, or -1
  std::vector<double> coordinates;   ///< of these nodes
  std::vector<std::int32_t> connectivity;
  std::vector<kacanov::Law> laws;  ///< linear ones, divided by `unit`
  std::vector<std::uint16_t> law_of_element;
  double unit = 1.0;           ///< a power of two near the moduli, so that single precision holds them
  std::uint64_t laws_set = 0;  ///< the operator's value at the last update
  std::vector<std::uint8_t> held;
  std::vector<std::int32_t> unit_rows;  ///< unknowns where z = r
  kacanov::IndexMap node_map;           ///< of one process
  std::optional<kacanov::Multigrid> cycle;
  std::vector<double> r, z;  ///< of the used nodes, if some are not used
  std::atomic<bool> busy = false;
  char message[512] = "";
};

namespace kacanov::c_api {

/// z = M r for all of the operator's unknowns.
void apply_multigrid(kacanov_multigrid& multigrid, std::span<const double> r, std::span<double> z);

}  // namespace kacanov::c_api
