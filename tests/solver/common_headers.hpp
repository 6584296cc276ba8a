// SPDX-License-Identifier: BSD-3-Clause
// Headers that most tests of the solver include, for precompilation.
#pragma once

#include <Eigen/Dense>
#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>
#include <kacanov/solve.hpp>

#include "../common_headers.hpp"
