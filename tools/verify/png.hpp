// SPDX-License-Identifier: BSD-3-Clause
// Reads grey values from PNG files.
#pragma once

#include <string>
#include <vector>

#include "verify/real.hpp"

namespace kacanov::verify {

/// Returns the rows of a file from top to bottom, values from 0 black to 1 white; only the first sample of
/// every pixel counts. Throws Failure if the file cannot be decompressed.
std::vector<std::vector<Real>> png_rows(const std::string& file);

}  // namespace kacanov::verify
