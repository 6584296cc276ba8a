// SPDX-License-Identifier: BSD-3-Clause
// Reads height maps from PNG files (ISO/IEC 15948).
#include "formats/png_heights.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>

#include <kacanov/error.hpp>
#include "formats/gmsh_cursor.hpp"
#include "formats/inflate.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// Samples per pixel: grey, RGB, grey with alpha, RGB with alpha; 0 for an invalid colour type or a palette.
std::size_t samples_of(unsigned colour_type) {
  constexpr std::size_t samples[] = {1, 0, 3, 0, 2, 0, 4};
  return colour_type < std::size(samples) ? samples[colour_type] : 0;
}

/// Paeth predictor: the one of left, above and upper left that is closest to left + above − upper left.
unsigned paeth(unsigned left, unsigned above, unsigned between) {
  const auto far = [&](unsigned x) {
    return std::abs(static_cast<int>(left + above) - static_cast<int>(between) - static_cast<int>(x));
  };
  if (far(left) <= far(above) && far(left) <= far(between)) return left;
  return far(above) <= far(between) ? above : between;
}

class PngPicture {
 public:
  PngPicture(const SourceFile& source, std::string_view bytes) : source_(source), bytes_(bytes) {}

  NumberGrid parse() {
    place_ = png_signature.size();
    Chunk chunk = take_chunk();
    if (chunk.name != "IHDR") fail("expected the chunk IHDR, got " + source_.quoted(chunk.name));
    take_header(chunk.data);
    std::string packed;
    for (chunk = take_chunk(); chunk.name != "IEND"; chunk = take_chunk())
      if (chunk.name == "IDAT") packed += chunk.data;
    unpack(packed);
    NumberGrid grid{height_, width_, {}};
    grid.values.reserve(height_ * width_);
    for (std::size_t row = 0; row < height_; ++row) add_row(grid, row);
    return grid;
  }

 private:
  struct Chunk {
    std::string_view name, data;
  };

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(source_.path + ": byte " + std::to_string(place_) + ": " + message);
  }

  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError(source_.path + ": " + message);
  }

  static std::size_t four_bytes(std::string_view bytes) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
    return value;
  }

  /// A chunk consists of length, name, data, and a checksum of name and data.
  Chunk take_chunk() {
    const std::string_view rest = bytes_.substr(place_);
    if (rest.size() < 12) fail("the file ends before the chunk IEND");
    const std::size_t length = four_bytes(rest);
    if (rest.size() - 12 < length)
      fail("the file ends within the chunk " + source_.quoted(rest.substr(4, 4)));
    const std::string_view checked = rest.substr(4, 4 + length);
    if (crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size()) !=
        four_bytes(rest.substr(8 + length)))
      fail("the chunk " + source_.quoted(checked.substr(0, 4)) + " is damaged: its checksum is another");
    place_ += 12 + length;
    return {checked.substr(0, 4), checked.substr(4)};
  }

  void take_header(std::string_view data) {
    if (data.size() != 13) refuse("expected a header of 13 bytes, got " + std::to_string(data.size()));
    width_ = four_bytes(data);
    height_ = four_bytes(data.substr(4));
    const auto at = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(data[k])); };
    bits_ = at(8);
    samples_ = samples_of(at(9));
    if (at(9) == 3) refuse("expected grey values, got a palette: save the picture as grey");
    const bool known = samples_ == 1 ? bits_ == 1 || bits_ == 2 || bits_ == 4 || bits_ == 8 || bits_ == 16
                                     : bits_ == 8 || bits_ == 16;
    if (samples_ == 0 || !known || at(10) != 0 || at(11) != 0)
      refuse("expected colour type, bits, compression and filter as PNG has them");
    if (at(12) != 0) refuse("expected a picture that is not interlaced: save it without");
    if (width_ == 0 || height_ == 0) refuse("expected a picture with at least one pixel");
    if (height_ > static_cast<std::size_t>(NumberGrid::most_values) / width_)
      refuse("expected at most 2^28 values, got " + std::to_string(width_) + " × " + std::to_string(height_));
  }

  std::size_t row_bytes() const { return (width_ * samples_ * bits_ + 7) / 8; }

  /// Decompresses the rows, each a filter type and filtered bytes, and reverses the filters.
  void unpack(const std::string& packed) {
    constexpr std::size_t most_packed = 1040;  // greatest compression ratio of a zlib stream
    const std::size_t length = row_bytes(), size = height_ * (length + 1);
    if (size / most_packed > packed.size()) refuse("the chunks IDAT are too short for the picture");
    rows_.resize(size);
    if (!inflate_zlib(packed, rows_)) refuse("the chunks IDAT are damaged, or not as long as the picture");
    const std::size_t step = std::max<std::size_t>(1, samples_ * bits_ / 8);
    for (std::size_t row = 0; row < height_; ++row) {
      unsigned char* now = rows_.data() + row * (length + 1) + 1;
      const unsigned filter = now[-1];
      if (filter > 4) refuse("expected filters from 0 to 4, got " + std::to_string(filter));
      for (std::size_t i = 0; i < length; ++i) {
        const unsigned left = i < step ? 0 : now[i - step], above = row == 0 ? 0 : (now - length - 1)[i],
                       between = row == 0 || i < step ? 0 : (now - length - 1)[i - step];
        const unsigned added[] = {0, left, above, (left + above) / 2, paeth(left, above, between)};
        now[i] = static_cast<unsigned char>(now[i] + added[filter]);
      }
    }
  }

  unsigned sample(std::size_t row, std::size_t index) const {
    const unsigned char* begin = rows_.data() + row * (row_bytes() + 1) + 1;
    if (bits_ == 16) return static_cast<unsigned>(begin[2 * index]) << 8 | begin[2 * index + 1];
    const std::size_t bit = index * bits_;
    return static_cast<unsigned>(begin[bit / 8]) >> (8 - bits_ - bit % 8) & ((1U << bits_) - 1);
  }

  void add_row(NumberGrid& grid, std::size_t row) const {
    const double most = static_cast<double>((1U << bits_) - 1);
    for (std::size_t i = 0; i < width_; ++i) {
      const unsigned grey = sample(row, i * samples_);
      if (samples_ > 2 && (sample(row, i * samples_ + 1) != grey || sample(row, i * samples_ + 2) != grey))
        refuse("expected grey values, got colours in row " + std::to_string(row + 1) + ", column " +
               std::to_string(i + 1));
      grid.values.push_back(grey / most);
    }
  }

  const SourceFile& source_;
  std::string_view bytes_;
  std::size_t place_ = 0, width_ = 0, height_ = 0, samples_ = 0, bits_ = 0;
  std::vector<unsigned char> rows_;
};

}  // namespace

bool is_png(std::string_view bytes) { return bytes.starts_with("\x89PNG"); }

NumberGrid parse_png(const SourceFile& source, std::string_view bytes) {
  if (!bytes.starts_with(png_signature))
    throw InputError(source.path + ": byte 0: expected the eight bytes that a PNG begins with");
  return PngPicture(source, bytes).parse();
}

}  // namespace kacanov
