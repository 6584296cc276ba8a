// SPDX-License-Identifier: BSD-3-Clause
// Unpacks zlib's streams (RFC 1950, 1951): the compressed blocks of VTK files, the pixels of PNG.
#pragma once

#include <span>
#include <string_view>

namespace kacanov {

/// Unpacks a whole stream into `out`, which it has to fill. Returns false where it is damaged, cut short, of
/// another length, or not what its checksum says.
bool inflate_zlib(std::string_view packed, std::span<unsigned char> out);

}  // namespace kacanov
