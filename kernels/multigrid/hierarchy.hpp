// SPDX-License-Identifier: BSD-3-Clause
// Interface of all hierarchies of the multigrid.
#pragma once

#include "multigrid/multigrid.hpp"

namespace kacanov {

/// The members of Multigrid, independent of the kind of levels.
struct Multigrid::Hierarchy {
  virtual ~Hierarchy() = default;
  virtual void build(std::span<const double> g, std::span<const NodeBlock> blocks,
                     const HeldSpace& space) = 0;
  virtual void rebuild(std::span<const NodeBlock> blocks, const HeldSpace& space) = 0;
  virtual void apply(std::span<const double> r, std::span<double> z, const Factors& factors) = 0;
  virtual void secant(std::span<double> g) const = 0;
  virtual int kind() const noexcept { return 0; }
  virtual int levels() const noexcept = 0;
  virtual std::size_t bytes() const noexcept = 0;
};

}  // namespace kacanov
