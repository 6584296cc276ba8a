// SPDX-License-Identifier: BSD-3-Clause
// From one share of the load to the next, and the history of what each came to.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "nonlinear/outer_loop.hpp"

namespace kacanov {

/// What a path asks of whom it is for; any may be empty.
struct LoadStepCalls {
  std::function<void(std::size_t)> begins = {};  ///< with the number of each step, from 0
  std::function<void()> over = {};               ///< once a step but the last is over
  std::function<Start(std::size_t)> coarse =
      {};  ///< what a coarser mesh says at its end, in the loop's units
};

/// Runs the loop at the shares that result.load_steps does not have yet, each from the end of the one before,
/// as long as each converges; adds the line of every share but the one it ends with. False: the run was asked
/// to stop. Collective.
bool run_load_steps(OuterLoop& loop, std::span<const double> shares, Result& result,
                    const LoadStepCalls& calls);

/// "load step 2 of 4 (factor 0.5)"; `number` from 0.
std::string load_step_name(std::size_t number, std::size_t of, bool by_time, double at);

/// The line of the history for a share whose totals `result` has, with the lines of those before.
LoadStep load_step_line(const Result& result, double share);

}  // namespace kacanov
