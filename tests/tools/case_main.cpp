// SPDX-License-Identifier: BSD-3-Clause
// Entry of the tests of the case file.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
