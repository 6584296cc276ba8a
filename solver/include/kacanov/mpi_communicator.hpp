// SPDX-License-Identifier: BSD-3-Clause
// Old name of <kacanov/part.hpp>: forwards for one release.
#pragma once

#include <kacanov/part.hpp>
