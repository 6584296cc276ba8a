// SPDX-License-Identifier: BSD-3-Clause
// Old name of <kacanov/solve.hpp>: forwards for one release.
#pragma once

#include <kacanov/solve.hpp>
