// SPDX-License-Identifier: BSD-3-Clause
// Entry point of the tests without MPI.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
