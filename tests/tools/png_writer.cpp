// SPDX-License-Identifier: BSD-3-Clause
// PNG files of all kinds for tests: filters, compression and checksums.
#include "png_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace kacanov::testing {
namespace {

std::string four_bytes(std::size_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}

int filtered(int filter, int left, int above, int between) {
  const int guess = left + above - between;
  switch (filter) {
    case 1: return left;
    case 2: return above;
    case 3: return (left + above) / 2;
    case 4: {
      const std::array<int, 3> order{left, above, between};
      int best = left;
      for (const int value : order)
        if (std::abs(guess - value) < std::abs(guess - best)) best = value;
      return best;
    }
    default: return 0;
  }
}

}  // namespace

std::string png_chunk(const std::string& name, const std::string& data) {
  const std::string checked = name + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return four_bytes(data.size()) + checked + four_bytes(sum);
}

std::string png(std::size_t width, std::size_t height, const std::vector<unsigned>& samples,
                const PngKind& kind) {
  constexpr std::size_t channels[] = {1, 0, 3, 1, 2, 0, 4};
  const std::size_t of_row = width * channels[kind.colour_type], bits = static_cast<std::size_t>(kind.bits),
                    length = (of_row * bits + 7) / 8,
                    step = std::max<std::size_t>(1, channels[kind.colour_type] * bits / 8);
  std::string bytes;
  std::vector<int> before(length);
  for (std::size_t y = 0; y < height; ++y) {
    std::vector<int> row(length);
    for (std::size_t i = 0; i < of_row; ++i) {
      const unsigned value = samples[y * of_row + i];
      if (bits == 16) {
        row[2 * i] = static_cast<int>(value >> 8);
        row[2 * i + 1] = static_cast<int>(value & 255);
      } else {
        row[i * bits / 8] |= static_cast<int>(value << (8 - bits - i * bits % 8));
      }
    }
    const int filter = kind.filter < 0 ? static_cast<int>(y % 5) : kind.filter;
    bytes += static_cast<char>(filter);
    for (std::size_t i = 0; i < length; ++i)
      bytes += static_cast<char>((row[i] - filtered(filter, i < step ? 0 : row[i - step], before[i],
                                                    i < step ? 0 : before[i - step])) &
                                 255);
    before = row;
  }
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  packed.resize(size);
  const std::string header = four_bytes(width) + four_bytes(height) + static_cast<char>(kind.bits) +
                             static_cast<char>(kind.colour_type) + std::string(2, '\0') +
                             static_cast<char>(kind.interlaced);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("tEXt", "Title\0heights") +
         png_chunk("IDAT", packed.substr(0, size / 2)) + png_chunk("IDAT", packed.substr(size / 2)) +
         png_chunk("IEND", "");
}

}  // namespace kacanov::testing
