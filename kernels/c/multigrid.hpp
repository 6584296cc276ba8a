// SPDX-License-Identifier: BSD-3-Clause
// The handle of a multigrid.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "c/handle.hpp"
#include "multigrid/multigrid.hpp"

/// What a multigrid keeps of an operator: copies, so that the operator may get other laws. Coordinates and
/// connectivity are the operator's, but where nodes belong to no element: these are left out.
struct kacanov_multigrid {
  kacanov_operator* op = nullptr;  ///< shared with the caller
  kacanov::MultigridOptions options;
  std::vector<std::int32_t>
      used;  ///< nodes with elements, where not all have; the multigrid knows only these
  std::vector<std::int32_t> number;  ///< of a node among them, or -1
  std::vector<double> coordinates;   ///< of these
  std::vector<std::int32_t> connectivity;
  std::vector<kacanov::Law> laws;  ///< linear ones, divided by `unit`
  std::vector<std::uint16_t> law_of_element;
  double unit = 1.0;           ///< a power of two near the moduli, so that single precision holds them
  std::uint64_t laws_set = 0;  ///< the operator's at the last update
  std::vector<std::uint8_t> held;
  std::vector<std::int32_t> unit_rows;  ///< unknowns where z = r
  kacanov::IndexMap node_map;           ///< of one process
  std::optional<kacanov::Multigrid> cycle;
  std::vector<double> r, z;  ///< of the nodes used, where not all are
  std::atomic<bool> busy = false;
  char message[512] = "";
};

namespace kacanov::c_api {

/// z = M r, both of all the operator's unknowns.
void apply_multigrid(kacanov_multigrid& multigrid, std::span<const double> r, std::span<double> z);

}  // namespace kacanov::c_api
