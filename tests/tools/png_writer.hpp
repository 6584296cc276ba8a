// SPDX-License-Identifier: BSD-3-Clause
// PNG files of any kind for tests.
#pragma once

#include <string>
#include <vector>

namespace kacanov::testing {

struct PngKind {
  int colour_type = 0;  ///< 0 grey, 2 colours, 3 palette, 4 grey and opacity, 6 colours and opacity
  int bits = 8;
  int filter = 0;  ///< 0 to 4, of every row; −1: one after the other
  int interlaced = 0;
};

/// `samples` are those of the rows from above, pixel by pixel.
std::string png(std::size_t width, std::size_t height, const std::vector<unsigned>& samples,
                const PngKind& kind = {});

/// A chunk with its length and checksum.
std::string png_chunk(const std::string& name, const std::string& data);

}  // namespace kacanov::testing
