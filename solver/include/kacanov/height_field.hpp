// SPDX-License-Identifier: BSD-3-Clause
// Old name of <kacanov/obstacle.hpp>: forwards for one release.
#pragma once

#include <kacanov/obstacle.hpp>
