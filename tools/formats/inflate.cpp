// SPDX-License-Identifier: BSD-3-Clause
// Decompresses blocks of VTK files and PNG data with zlib.
#include "formats/inflate.hpp"

#include <zlib.h>

namespace kacanov {

bool inflate_zlib(std::string_view packed, std::span<unsigned char> out) {
  uLongf size = out.size();
  unsigned char nothing = 0;  // zlib needs a valid pointer even for zero bytes
  unsigned char* to = out.empty() ? &nothing : out.data();
  uLong used = packed.size();
  return uncompress2(to, &size, reinterpret_cast<const Bytef*>(packed.data()), &used) == Z_OK &&
         size == out.size();
}

}  // namespace kacanov
