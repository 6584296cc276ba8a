// SPDX-License-Identifier: BSD-3-Clause
// Old name of <kacanov/refine.hpp>: forwards for one release.
#pragma once

#include <kacanov/refine.hpp>
