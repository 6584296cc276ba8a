// SPDX-License-Identifier: BSD-3-Clause
// Grey values of a PNG.
#pragma once

#include <string>
#include <vector>

#include "verify/real.hpp"

namespace kacanov::verify {

/// The rows of a whole file, the upper one first, from 0 black to 1 white; the first sample of every pixel.
/// Throws Failure where it cannot be unpacked.
std::vector<std::vector<Real>> png_rows(const std::string& file);

}  // namespace kacanov::verify
