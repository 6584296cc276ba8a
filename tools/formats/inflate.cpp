// SPDX-License-Identifier: BSD-3-Clause
// Hands what VTK files and PNG have compressed to zlib.
#include "formats/inflate.hpp"

#include <zlib.h>

namespace kacanov {

bool inflate_zlib(std::string_view packed, std::span<unsigned char> out) {
  uLongf size = out.size();
  unsigned char nothing = 0;  // zlib wants a place, even for no bytes
  unsigned char* to = out.empty() ? &nothing : out.data();
  uLong used = packed.size();
  return uncompress2(to, &size, reinterpret_cast<const Bytef*>(packed.data()), &used) == Z_OK &&
         size == out.size();
}

}  // namespace kacanov
