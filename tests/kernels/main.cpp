// SPDX-License-Identifier: BSD-3-Clause
// Entry of the kernels' test program.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
