// SPDX-License-Identifier: BSD-3-Clause
// Entry of the tests of build_problem.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
