// SPDX-License-Identifier: BSD-3-Clause
// hypre's BoomerAMG on the assembled penalised secant stiffness, owned by RAII, return codes checked.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "part.hpp"

namespace kacanov {

/// A dim × dim block added to the diagonal of a node: a contact penalty, or a direction held.
struct NodeBlock {
  std::int32_t node = 0;
  std::array<double, 9> value{};  ///< dim × dim, row-major
};

/// One V-cycle of unknown-based BoomerAMG as a preconditioner. Held components are decoupled.
class Amg {
 public:
  explicit Amg(const Part& part);
  ~Amg();
  Amg(Amg&&) noexcept;
  Amg& operator=(Amg&&) noexcept;

  /// Builds the hierarchy for frozen g (elements × points of this part) and the blocks of *owned* nodes.
  /// Collective.
  void setup(std::span<const double> g, std::span<const NodeBlock> blocks);
  /// z ≈ A⁻¹ r for consistent r; z is consistent. Collective.
  void apply(std::span<const double> r, std::span<double> z) const;

  int setups() const noexcept;
  double setup_seconds() const noexcept;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kacanov
