// SPDX-License-Identifier: BSD-3-Clause
// From one share of the load to the next, and the history of what each came to.
#pragma once

#include <functional>
#include <span>

#include "nonlinear/outer_loop.hpp"

namespace kacanov {

/// What a coarser mesh says at the end of a load step, in the loop's units; empty where there is none.
using CoarsePath = std::function<Start(std::size_t)>;

/// Runs the loop at the shares that result.load_steps does not have yet, each from the end of the one before,
/// as long as each converges; adds the line of every share but the one it ends with, and calls `over` then.
/// False: the run was asked to stop. Collective.
bool run_load_steps(OuterLoop& loop, std::span<const double> shares, Result& result,
                    const std::function<void()>& over, const CoarsePath& coarse = {});

/// The line of the history for a share whose totals `result` has, with the lines of those before.
LoadStep load_step_line(const Result& result, double share);

}  // namespace kacanov
