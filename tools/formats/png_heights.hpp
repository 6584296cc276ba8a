// SPDX-License-Identifier: BSD-3-Clause
// Reads height maps from PNG files (ISO/IEC 15948).
#pragma once

#include <string_view>

#include "formats/number_grid.hpp"
#include "formats/source_file.hpp"

namespace kacanov {

bool is_png(std::string_view bytes);
/// Returns grey values from 0 black to 1 white, 1 to 16 bits deep; colour pictures are accepted only if all
/// pixels are grey. Alpha is ignored. `bytes` is the whole file; `source` names it in messages. Throws
/// InputError if the picture is not grey, is interlaced, or is damaged or truncated, with the byte.
NumberGrid parse_png(const SourceFile& source, std::string_view bytes);

}  // namespace kacanov
