// SPDX-License-Identifier: BSD-3-Clause
// Height maps from PNG files (ISO/IEC 15948).
#pragma once

#include <string_view>

#include "formats/number_grid.hpp"
#include "formats/source_file.hpp"

namespace kacanov {

bool is_png(std::string_view bytes);
/// Grey values from 0 black to 1 white, of 1 to 16 bits; of a picture in colours only where all its pixels
/// are grey. Transparency does not count. `bytes` is the whole file, `source` its name in messages. Throws
/// InputError: no grey, interlaced, or damaged or cut short at which byte.
NumberGrid parse_png(const SourceFile& source, std::string_view bytes);

}  // namespace kacanov
