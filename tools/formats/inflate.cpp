// SPDX-License-Identifier: BSD-3-Clause
// Unpacks zlib's streams (RFC 1950, 1951): the compressed blocks of VTK files.
#include "formats/inflate.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kacanov {
namespace {

constexpr std::size_t longest_code = 15;

/// A canonical Huffman code: how many symbols have codes of each length, and the symbols in their order.
struct Code {
  std::array<int, longest_code + 1> count{};
  std::vector<int> symbols;

  /// False where the lengths are those of no code.
  bool assign(std::span<const std::uint8_t> lengths) {
    count.fill(0);
    for (const std::uint8_t length : lengths) ++count[length];
    count[0] = 0;
    int left = 1;
    std::array<int, longest_code + 2> first{};
    for (std::size_t n = 1; n <= longest_code; ++n) {
      left = 2 * left - count[n];
      if (left < 0) return false;
      first[n + 1] = first[n] + count[n];
    }
    symbols.assign(lengths.size(), 0);
    for (std::size_t s = 0; s < lengths.size(); ++s)
      if (lengths[s] != 0) symbols[first[lengths[s]]++] = static_cast<int>(s);
    return true;
  }
};

class Inflater {
 public:
  Inflater(std::string_view in, std::span<unsigned char> out) : in_(in), out_(out) {}

  bool run() {
    for (bool last = false; !last;) {
      last = bits(1) == 1;
      const int kind = bits(2);
      if (bad_) return false;
      if (kind == 3 || !(kind == 0 ? stored() : compressed(kind == 2))) return false;
    }
    return at_ == out_.size();
  }
  /// What is left of the input.
  std::string_view rest() const { return in_; }

 private:
  int bits(int count) {
    while (have_ < count) {
      if (in_.empty()) {
        bad_ = true;
        return 0;
      }
      buffer_ |= static_cast<std::uint32_t>(static_cast<unsigned char>(in_.front())) << have_;
      in_.remove_prefix(1);
      have_ += 8;
    }
    const auto value = static_cast<int>(buffer_ & ((1u << count) - 1));
    buffer_ >>= count;
    have_ -= count;
    return value;
  }

  bool stored() {
    buffer_ = 0;
    have_ = 0;
    const int length = bits(16), inverse = bits(16);
    if (bad_ || length != (inverse ^ 0xffff)) return false;
    const auto bytes = static_cast<std::size_t>(length);
    if (in_.size() < bytes || out_.size() - at_ < bytes) return false;
    for (std::size_t i = 0; i < bytes; ++i) out_[at_++] = static_cast<unsigned char>(in_[i]);
    in_.remove_prefix(bytes);
    return true;
  }

  int symbol(const Code& code) {
    int value = 0, first = 0, index = 0;
    for (std::size_t n = 1; n <= longest_code && !bad_; ++n) {
      value |= bits(1);
      const int count = code.count[n];
      if (value - count < first) return code.symbols[index + value - first];
      index += count;
      first = 2 * (first + count);
      value *= 2;
    }
    bad_ = true;
    return 0;
  }

  bool read_codes(Code& literals, Code& distances) {
    constexpr std::array<std::uint8_t, 19> order{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                 11, 4,  12, 3, 13, 2, 14, 1, 15};
    const std::size_t letters = bits(5) + 257, ways = bits(5) + 1, codes = bits(4) + 4;
    std::array<std::uint8_t, 19> short_lengths{};
    for (std::size_t i = 0; i < codes; ++i) short_lengths[order[i]] = static_cast<std::uint8_t>(bits(3));
    Code lengths_code;
    if (bad_ || !lengths_code.assign(short_lengths)) return false;
    std::vector<std::uint8_t> lengths;
    while (lengths.size() < letters + ways) {
      const int s = symbol(lengths_code);
      if (bad_ || (s == 16 && lengths.empty())) return false;
      if (s < 16)
        lengths.push_back(static_cast<std::uint8_t>(s));
      else
        lengths.insert(lengths.end(),
                       s == 16   ? 3 + bits(2)
                       : s == 17 ? 3 + bits(3)
                                 : 11 + bits(7),
                       s == 16 ? lengths.back() : std::uint8_t{0});
    }
    if (bad_ || lengths.size() != letters + ways) return false;
    return literals.assign(std::span(lengths).first(letters)) &&
           distances.assign(std::span(lengths).subspan(letters));
  }

  static void fixed_codes(Code& literals, Code& distances) {
    std::array<std::uint8_t, 288> lengths{};
    for (std::size_t s = 0; s < 288; ++s) lengths[s] = s < 144 ? 8 : s < 256 ? 9 : s < 280 ? 7 : 8;
    literals.assign(lengths);
    std::array<std::uint8_t, 30> fives{};
    fives.fill(5);
    distances.assign(fives);
  }

  bool compressed(bool with_codes) {
    Code literals, distances;
    if (!with_codes)
      fixed_codes(literals, distances);
    else if (!read_codes(literals, distances))
      return false;
    for (;;) {
      const int s = symbol(literals);
      if (bad_) return false;
      if (s == 256) return true;
      if (s < 256) {
        if (at_ == out_.size()) return false;
        out_[at_++] = static_cast<unsigned char>(s);
      } else if (!copy(s - 257, distances)) {
        return false;
      }
    }
  }

  /// Repeats what has come before.
  bool copy(int length_symbol, const Code& distances) {
    constexpr std::array<int, 29> length_base{3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                              31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
    constexpr std::array<int, 29> length_bits{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                              2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
    constexpr std::array<int, 30> way_base{1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                                           33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                                           1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    constexpr std::array<int, 30> way_bits{0, 0, 0, 0, 1, 1, 2, 2,  3,  3,  4,  4,  5,  5,  6,
                                           6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13};
    if (length_symbol >= 29) return false;
    const std::size_t length = length_base[length_symbol] + bits(length_bits[length_symbol]);
    const int way = symbol(distances);
    if (bad_ || way >= 30) return false;
    const std::size_t distance = way_base[way] + bits(way_bits[way]);
    if (bad_ || distance > at_ || length > out_.size() - at_) return false;
    for (std::size_t i = 0; i < length; ++i, ++at_) out_[at_] = out_[at_ - distance];
    return true;
  }

  std::string_view in_;
  std::span<unsigned char> out_;
  std::size_t at_ = 0;
  std::uint32_t buffer_ = 0;
  int have_ = 0;
  bool bad_ = false;
};

std::uint32_t adler32(std::span<const unsigned char> bytes) {
  std::uint32_t a = 1, b = 0;
  for (const unsigned char byte : bytes) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  return (b << 16) | a;
}

}  // namespace

bool inflate_zlib(std::string_view packed, std::span<unsigned char> out) {
  if (packed.size() < 6) return false;
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(packed[i]));
  };
  if ((byte(0) & 15) != 8 || (byte(0) * 256 + byte(1)) % 31 != 0 || (byte(1) & 32) != 0) return false;
  Inflater inflater(packed.substr(2, packed.size() - 6), out);
  if (!inflater.run()) return false;
  const std::size_t end = packed.size() - 4;
  return adler32(out) == (byte(end) << 24 | byte(end + 1) << 16 | byte(end + 2) << 8 | byte(end + 3));
}

}  // namespace kacanov
