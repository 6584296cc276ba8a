// SPDX-License-Identifier: BSD-3-Clause
// What most tests of the solver include, to be parsed once for all where headers are precompiled.
#pragma once

#include <Eigen/Dense>
#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>
#include <kacanov/solve.hpp>

#include "../common_headers.hpp"
