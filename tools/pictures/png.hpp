// SPDX-License-Identifier: BSD-3-Clause
// A small PNG encoder for images with a palette.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "pictures/colour_scale.hpp"

namespace kacanov {

/// `pixels`: row by row from the top, `width` per row, each an index into `palette` (at most 256 colours);
/// index 0 is transparent. Returns the bytes of the file.
std::string encode_png(std::size_t width, std::span<const std::uint8_t> pixels, std::span<const Rgb> palette);

std::string base64(std::string_view bytes);

}  // namespace kacanov
