// SPDX-License-Identifier: BSD-3-Clause
// Old name of <kacanov/model.hpp>: forwards for one release.
#pragma once

#include <kacanov/model.hpp>
