// SPDX-License-Identifier: BSD-3-Clause
// A power law twice, on handles of the C interface: built in, and as a law of the caller's own.
#pragma once

#include <memory>
#include <span>

#include <kacanov/kacanov.h>
#include "meshes.hpp"

namespace kacanov::perf {

/// The body whose points are all beyond yield at displacements of the size of an element.
class PowerLawBody {
 public:
  /// `mesh` has to outlive it. `own`: the law comes as a callback, which all threads may ask.
  PowerLawBody(const meshes::OwnedMesh& mesh, bool own, int threads);
  void residual(std::span<const double> u, std::span<double> f);
  void update_tangent(std::span<const double> u);

 private:
  struct Destroy {
    void operator()(kacanov_operator* op) const { kacanov_destroy(op); }
  };
  std::unique_ptr<kacanov_operator, Destroy> op_;
};

}  // namespace kacanov::perf
