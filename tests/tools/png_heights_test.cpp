// SPDX-License-Identifier: BSD-3-Clause
// PNG height maps: every kind of grey image, and rejected files.
#include <doctest/doctest.h>

#include <random>

#include <kacanov/error.hpp>
#include "formats/height_reader.hpp"
#include "png_writer.hpp"

using namespace kacanov;
using testing::png;
using testing::PngKind;

namespace {

std::vector<unsigned> some_samples(std::size_t count, int bits, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<unsigned> samples(count);
  for (unsigned& sample : samples) sample = static_cast<unsigned>(random() % (1U << bits));
  return samples;
}

}  // namespace

TEST_CASE("heights of a PNG are those of the PGM with the same grey, of any bits and filter") {
  for (const int bits : {1, 2, 4, 8, 16})
    for (const int filter : {-1, 0, 1, 2, 3, 4})
      for (const std::size_t width : {2U, 7U, 33U}) {
        CAPTURE(bits);
        CAPTURE(filter);
        CAPTURE(width);
        const auto samples = some_samples(width * 11, bits, static_cast<unsigned>(width));
        std::string pgm = "P2\n" + std::to_string(width) + " 11\n" + std::to_string((1 << bits) - 1) + "\n";
        for (const unsigned sample : samples) pgm += std::to_string(sample) + "\n";
        const NumberGrid expected = parse_heights("a.pgm", pgm),
                         grid = parse_heights("a.png", png(width, 11, samples, {0, bits, filter, 0}));
        CHECK(grid.rows == expected.rows);
        CHECK(grid.columns == expected.columns);
        CHECK(grid.values == expected.values);
      }
}

TEST_CASE("opacity does not count, and colours are taken where they are grey") {
  for (const int bits : {8, 16})
    for (const int filter : {-1, 4}) {
      const auto grey = some_samples(5 * 6, bits, 3);
      const NumberGrid expected = parse_heights("a.png", png(5, 6, grey, {0, bits, 0, 0}));
      for (const int type : {2, 4, 6}) {
        CAPTURE(type);
        std::vector<unsigned> samples;
        for (const unsigned value : grey) {
          samples.insert(samples.end(), type == 4 ? 1 : 3, value);
          if (type != 2) samples.push_back(static_cast<unsigned>(samples.size()) % 256);
        }
        CHECK(parse_heights("a.png", png(5, 6, samples, {type, bits, filter, 0})).values == expected.values);
      }
    }
}

TEST_CASE("a PNG that holds no heights is refused with the reason") {
  const std::vector<unsigned> values{1, 2, 3, 4, 5, 6};
  const std::string whole = png(3, 2, values);
  const auto refuses = [](const std::string& bytes, const char* message) {
    CAPTURE(message);
    CHECK_THROWS_WITH_AS(parse_heights("a.png", bytes), doctest::Contains(message), InputError);
  };
  refuses(png(3, 2, values, {3, 8, 0, 0}), "a.png: expected grey values, got a palette");
  refuses(png(3, 2, values, {0, 8, 0, 1}), "a.png: expected a picture that is not interlaced");
  refuses(png(3, 2, values, {0, 8, 5, 0}), "a.png: expected filters from 0 to 4, got 5");
  refuses(png(3, 1, values), "expected at least 2 × 2 heights, got 1 × 3");
  refuses(png(2, 1, {9, 9, 9, 9, 8, 9}, {2, 8, 0, 0}), "got colours in row 1, column 2");
  refuses("\x89PNG\r\n", "byte 0: expected the eight bytes that a PNG begins with");
  for (std::size_t length = 8; length < whole.size(); ++length)
    CHECK_THROWS_AS(parse_heights("a.png", whole.substr(0, length)), InputError);
  refuses(whole.substr(0, 30), "byte 8: the file ends within the chunk \"IHDR\"");
  refuses(whole.substr(0, whole.size() - 12), "the file ends before the chunk IEND");
  std::string damaged = whole;
  damaged[19] = 4;  // the width
  refuses(damaged, "byte 8: the chunk \"IHDR\" is damaged");
  // A few bytes that declare a thousand million pixels.
  const std::string signature = whole.substr(0, 8), end = testing::png_chunk("IEND", "");
  const auto header = [](const char* size) {
    return testing::png_chunk("IHDR", std::string(size, 8) + std::string("\x08\0\0\0\0", 5));
  };
  refuses(signature + header("\0\0\x3f\xff\0\0\x3f\xff") + end, "the chunks IDAT are too short");
  refuses(signature + header("\x7f\xff\xff\xff\x7f\xff\xff\xff") + end, "expected at most 2^28 values");
  refuses(signature + header("\0\0\0\0\0\0\0\x02") + end, "at least one pixel");
  refuses(signature + end, "expected the chunk IHDR, got \"IEND\"");
  refuses(signature + header("\0\0\0\x03\0\0\0\x02") + testing::png_chunk("IDAT", "no stream") + end,
          "the chunks IDAT are damaged");
}
