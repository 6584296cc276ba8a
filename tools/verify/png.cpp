// SPDX-License-Identifier: BSD-3-Clause
// Reads grey values from PNG files: decompresses all rows with zlib, then reverses the row filters.
#include "verify/png.hpp"

#include <zlib.h>

#include <cmath>
#include <cstdint>

namespace kacanov::verify {
namespace {

std::uint32_t big_endian(const std::string& file, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = 256 * value + static_cast<unsigned char>(file.at(at + k));
  return value;
}

}  // namespace

std::vector<std::vector<Real>> png_rows(const std::string& file) {
  const std::size_t width = big_endian(file, 16), height = big_endian(file, 20);
  const auto depth = static_cast<std::size_t>(file.at(24));
  const std::size_t channels = (file.at(25) & 2 ? 3 : 1) + (file.at(25) & 4 ? 1 : 0);
  std::string stream;
  for (std::size_t at = 8; at + 12 <= file.size(); at += 12 + big_endian(file, at))
    if (file.compare(at + 4, 4, "IDAT") == 0) stream += file.substr(at + 8, big_endian(file, at));

  const std::size_t stride = (width * channels * depth + 7) / 8, back = (channels * depth + 7) / 8;
  std::vector<unsigned char> bytes(height * (stride + 1));
  uLongf got = bytes.size();
  if (uncompress(bytes.data(), &got, reinterpret_cast<const Bytef*>(stream.data()), stream.size()) != Z_OK ||
      got != bytes.size())
    throw Failure("a height map: the PNG cannot be unpacked");

  std::vector<std::vector<Real>> rows(height, std::vector<Real>(width));
  std::vector<int> upper(stride + back), line(stride + back);  // zeros to the left
  for (std::size_t y = 0; y < height; ++y, upper.swap(line)) {
    const unsigned char* in = &bytes[y * (stride + 1)];
    for (std::size_t x = back; x < stride + back; ++x) {
      const int a = line[x - back], b = upper[x], c = upper[x - back], p = a + b - c;
      int guess = 0;
      if (*in == 1) guess = a;
      if (*in == 2) guess = b;
      if (*in == 3) guess = (a + b) / 2;
      if (*in == 4) {
        guess = c;
        if (std::abs(p - b) <= std::abs(p - c)) guess = b;
        if (std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c)) guess = a;
      }
      line[x] = (in[1 + x - back] + guess) % 256;
    }
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t bit = x * channels * depth, byte = back + bit / 8;
      int value = line[byte];
      if (depth == 16) value = 256 * value + line[byte + 1];
      if (depth < 8) value = value / (1 << (8 - depth - bit % 8)) % (1 << depth);
      rows[y][x] = Real(value) / Real((1 << depth) - 1);
    }
  }
  return rows;
}

}  // namespace kacanov::verify
