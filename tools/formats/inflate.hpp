// SPDX-License-Identifier: BSD-3-Clause
// Decompresses zlib streams (RFC 1950, 1951): the blocks of VTK files and the pixels of PNG.
#pragma once

#include <span>
#include <string_view>

namespace kacanov {

/// Decompresses a whole stream into `out`, which it must fill exactly. Returns false if the stream is
/// damaged, truncated, of another length, or fails its checksum.
bool inflate_zlib(std::string_view packed, std::span<unsigned char> out);

}  // namespace kacanov
