// SPDX-License-Identifier: BSD-3-Clause
// Arrays cut into blocks of one length, each packed by zlib by itself, as VTK keeps them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace kacanov {

/// Of all blocks but an array's last, unpacked.
inline constexpr std::size_t block_bytes = std::size_t{1} << 16;

/// Takes an array from front to back.
class BlockSink {
 public:
  virtual ~BlockSink() = default;
  /// Bytes that fill a block only with what comes before or behind them; fewer than a block has.
  virtual void loose(std::span<const unsigned char> bytes) = 0;
  /// Whole blocks, packed, one behind the other, and the length of each.
  virtual void packed(std::span<const unsigned char> bytes, std::span<const std::uint64_t> lengths) = 0;
};

/// Packs blocks one after the other; zlib's tables are set up once for all of them.
class BlockDeflater {
 public:
  BlockDeflater();
  ~BlockDeflater();
  /// Adds a block, packed, to `out`, and returns its length there. What zlib would hardly shorten is wrapped
  /// as it is: the digits of fields are noise to it, and trying costs ten times as long as writing them.
  std::size_t pack(std::span<const unsigned char> block, std::vector<unsigned char>& out);

 private:
  struct Stream;
  std::span<const unsigned char> shortened(std::span<const unsigned char> block);

  std::unique_ptr<Stream> stream_;
  std::vector<unsigned char> room_, last_, last_packed_;  ///< last_: of those that zlib has shortened
};

/// The same of any block, by hand: zlib takes five times as long to leave bytes as they are.
std::size_t wrap_as_it_is(std::span<const unsigned char> block, std::vector<unsigned char>& out);

/// Cuts a share of an array, which lies anywhere in it, at the ends of the array's blocks.
class BlockPacker {
 public:
  /// No call of BlockSink::packed has more bytes than this.
  static constexpr std::size_t most = std::size_t{5} << 18;

  /// `before`: bytes of the array ahead of the share.
  BlockPacker(std::uint64_t before, BlockSink& sink);
  void write(const void* data, std::size_t bytes);
  /// To be called last.
  void finish();

 private:
  void pack(std::span<const unsigned char> block);
  void hand_over();

  BlockSink& sink_;
  BlockDeflater deflater_;
  std::size_t head_;  ///< bytes that are missing to the end of the block that the share begins in
  std::vector<unsigned char> block_, packed_;
  std::vector<std::uint64_t> lengths_;
};

}  // namespace kacanov
