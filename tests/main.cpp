// SPDX-License-Identifier: BSD-3-Clause
// Entry of the tests that do without MPI.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
