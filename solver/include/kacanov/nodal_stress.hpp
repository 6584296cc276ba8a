// SPDX-License-Identifier: BSD-3-Clause
// Old name of <kacanov/discretisation.hpp>: forwards for one release.
#pragma once

#include <kacanov/discretisation.hpp>
