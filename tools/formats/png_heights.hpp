// SPDX-License-Identifier: BSD-3-Clause
// Height maps from PNG files (ISO/IEC 15948).
#pragma once

#include <string>
#include <string_view>

#include "formats/number_grid.hpp"

namespace kacanov {

bool is_png(std::string_view bytes);
/// Grey values from 0 black to 1 white, of 1 to 16 bits; of a picture in colours only where all its pixels
/// are grey. Transparency does not count. `bytes` is the whole file, `path` its name in messages. Throws
/// InputError: no grey, interlaced, or damaged or cut short at which byte.
NumberGrid parse_png(const std::string& path, std::string_view bytes);

}  // namespace kacanov
