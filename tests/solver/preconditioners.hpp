// SPDX-License-Identifier: BSD-3-Clause
// Creates every preconditioner of the solver by name.
#pragma once

#include <memory>
#include <string>

#include "amg/assembly.hpp"
#include "amg/make_preconditioner.hpp"

namespace kacanov::testing {

/// Returns the preconditioner `multigrid`, `elasticity` or `factor`. Collective.
inline std::unique_ptr<Preconditioner> preconditioner_named(const std::string& name, const Part& part) {
  if (name == "factor") return std::make_unique<Factorised>(part);
  SolverOptions options;
  if (name == "elasticity") options.preconditioner = SolverOptions::Preconditioner::elasticity;
  return make_preconditioner(options, part, 1, "");
}

}  // namespace kacanov::testing
