// SPDX-License-Identifier: BSD-3-Clause
// A power law on handles of the C interface: built in, and as a user-defined law.
#pragma once

#include <memory>
#include <span>

#include <kacanov/kacanov.h>
#include "meshes.hpp"

namespace kacanov::perf {

/// A body whose points are all beyond yield at displacements of the size of an element.
class PowerLawBody {
 public:
  /// `mesh` must outlive this object. With `own` the law is a callback, which all threads may call.
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
