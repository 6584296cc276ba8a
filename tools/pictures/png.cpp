// SPDX-License-Identifier: BSD-3-Clause
// PNG chunks with checksums, and a small deflate encoder for their rows.
#include "pictures/png.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace kacanov {
namespace {

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::uint32_t crc32(std::string_view bytes) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> result{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320U ^ (c >> 1) : c >> 1;
      result[n] = c;
    }
    return result;
  }();
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) crc = table[(crc ^ static_cast<std::uint8_t>(byte)) & 0xff] ^ (crc >> 8);
  return ~crc;
}

std::uint32_t adler32(std::span<const std::uint8_t> bytes) {
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : bytes) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

/// Deflate (RFC 1951) with the fixed code. Matches are searched at two distances only, the previous pixel and
/// the row above, which suffices for areas of one colour.
class Deflate {
 public:
  std::string compress(std::span<const std::uint8_t> bytes, std::size_t row) {
    bits(3, 3);  // last block, fixed code
    for (std::size_t i = 0; i < bytes.size();) {
      std::size_t length = 0, distance = 0;
      for (const std::size_t d : {std::size_t{1}, row}) {
        const std::size_t found = match(bytes, i, d);
        if (found > length) {
          length = found;
          distance = d;
        }
      }
      if (length < 3 || distance > 32768) {
        literal(bytes[i++]);
      } else {
        copy(length, distance);
        i += length;
      }
    }
    literal(256);
    bits(0, 7);  // pads the last byte
    return std::move(out_);
  }

 private:
  static std::size_t match(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t distance) {
    if (distance > at) return 0;
    const std::size_t limit = std::min<std::size_t>(258, bytes.size() - at);
    std::size_t length = 0;
    while (length < limit && bytes[at + length] == bytes[at + length - distance]) ++length;
    return length;
  }

  void bits(std::uint32_t value, int count) {
    for (int k = 0; k < count; ++k) {
      byte_ = static_cast<std::uint8_t>(byte_ | ((value >> k) & 1) << filled_);
      if (++filled_ < 8) continue;
      out_ += static_cast<char>(byte_);
      byte_ = 0;
      filled_ = 0;
    }
  }

  /// Codes are written from the highest bit.
  void code(std::uint32_t value, int count) {
    for (int k = count - 1; k >= 0; --k) bits(value >> k & 1, 1);
  }

  void literal(std::uint32_t symbol) {
    if (symbol < 144)
      code(0x30 + symbol, 8);
    else if (symbol < 256)
      code(0x190 + symbol - 144, 9);
    else if (symbol < 280)
      code(symbol - 256, 7);
    else
      code(0xc0 + symbol - 280, 8);
  }

  void copy(std::size_t length, std::size_t distance) {
    constexpr std::array<std::uint16_t, 29> lengths{3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                    15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                    67, 83, 99, 115, 131, 163, 195, 227, 258};
    const auto l = std::upper_bound(lengths.begin(), lengths.end(), length) - lengths.begin() - 1;
    literal(257 + static_cast<std::uint32_t>(l));
    const int length_bits = l < 8 || l == 28 ? 0 : static_cast<int>(l / 4) - 1;
    bits(static_cast<std::uint32_t>(length - lengths[l]), length_bits);
    // Distance codes: two per power of two.
    std::uint32_t symbol = 0, base = 1;
    int extra = 0;
    while (base + (1U << extra) <= distance) {
      base += 1U << extra;
      ++symbol;
      extra = symbol < 4 ? 0 : static_cast<int>(symbol / 2) - 1;
    }
    code(symbol, 5);
    bits(static_cast<std::uint32_t>(distance) - base, extra);
  }

  std::string out_;
  std::uint8_t byte_ = 0;
  int filled_ = 0;
};

std::string chunk(std::string_view type, std::string_view data) {
  const std::string body = std::string(type).append(data);
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc32(body));
}

}  // namespace

std::string encode_png(std::size_t width, std::span<const std::uint8_t> pixels,
                       std::span<const Rgb> palette) {
  const std::size_t height = pixels.size() / width;
  std::vector<std::uint8_t> rows;  // each row starts with its filter type, 0: none
  rows.reserve(height * (width + 1));
  for (std::size_t y = 0; y < height; ++y) {
    rows.push_back(0);
    rows.insert(rows.end(), pixels.begin() + static_cast<std::ptrdiff_t>(y * width),
                pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * width));
  }
  std::string colours;
  for (const Rgb& c : palette)
    for (const std::uint8_t part : c) colours += static_cast<char>(part);
  const std::string header = big_endian(static_cast<std::uint32_t>(width)) +
                             big_endian(static_cast<std::uint32_t>(height)) +
                             std::string("\x08\x03\0\0\0", 5);
  const std::string data = "\x78\x01" + Deflate().compress(rows, width + 1) + big_endian(adler32(rows));
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("PLTE", colours) +
         chunk("tRNS", std::string(1, '\0')) + chunk("IDAT", data) + chunk("IEND", "");
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      result += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return result;
}

}  // namespace kacanov
