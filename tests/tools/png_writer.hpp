// SPDX-License-Identifier: BSD-3-Clause
// Writes PNG files of all kinds for tests.
#pragma once

#include <string>
#include <vector>

namespace kacanov::testing {

struct PngKind {
  int colour_type = 0;  ///< 0 grey, 2 RGB, 3 palette, 4 grey with alpha, 6 RGB with alpha
  int bits = 8;
  int filter = 0;  ///< of every row, 0 to 4; −1: all of them in turn
  int interlaced = 0;
};

/// Returns a PNG file. `samples` lists the rows from the top, pixel by pixel.
std::string png(std::size_t width, std::size_t height, const std::vector<unsigned>& samples,
                const PngKind& kind = {});

/// Returns a chunk with its length and checksum.
std::string png_chunk(const std::string& name, const std::string& data);

}  // namespace kacanov::testing
