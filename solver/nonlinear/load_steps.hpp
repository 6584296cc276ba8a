// SPDX-License-Identifier: BSD-3-Clause
// Runs the load steps, and records their history.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "nonlinear/outer_loop.hpp"

namespace kacanov {

/// Callbacks of a load path; any may be empty.
struct LoadStepCalls {
  std::function<void(std::size_t)> begins = {};  ///< at the start of each step, with its number from 0
  std::function<void()> over = {};               ///< at the end of each step but the last
  /// Returns a coarser mesh's state at the end of a load step, in the loop's units.
  std::function<Start(std::size_t)> coarse = {};
};

/// Runs the loop at the shares that result.load_steps does not contain yet, each from the end of the previous
/// one, as long as each converges; appends a line for every share but the last one reached. Returns false if
/// the run was asked to stop. Collective.
bool run_load_steps(OuterLoop& loop, std::span<const double> shares, Result& result,
                    const LoadStepCalls& calls);

/// Returns "load step 2 of 4 (factor 0.5)"; `number` counts from 0.
std::string load_step_name(std::size_t number, std::size_t of, bool by_time, double at);

/// Returns the history line of a share from the totals in `result`, relative to the lines before.
LoadStep load_step_line(const Result& result, double share);

}  // namespace kacanov
