// SPDX-License-Identifier: BSD-3-Clause
// Splits arrays into blocks of equal length, each compressed by zlib on its own, as VTK stores them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace kacanov {

/// Uncompressed size of every block except the last of an array.
inline constexpr std::size_t block_bytes = std::size_t{1} << 16;

/// Receives an array from front to back.
class BlockSink {
 public:
  virtual ~BlockSink() = default;
  /// Part of a block that continues before or after this share; less than one block.
  virtual void loose(std::span<const unsigned char> bytes) = 0;
  /// Whole compressed blocks, contiguous, and the length of each.
  virtual void packed(std::span<const unsigned char> bytes, std::span<const std::uint64_t> lengths) = 0;
};

/// Compresses blocks one after the other and reuses zlib's tables.
class BlockDeflater {
 public:
  BlockDeflater();
  ~BlockDeflater();
  /// Appends the compressed block to `out` and returns its length there. Blocks that zlib would hardly shrink
  /// are stored: the digits of fields look like noise, and trying costs ten times as long as writing them.
  std::size_t pack(std::span<const unsigned char> block, std::vector<unsigned char>& out);

 private:
  struct Stream;
  std::span<const unsigned char> shortened(std::span<const unsigned char> block);

  std::unique_ptr<Stream> stream_;
  std::vector<unsigned char> room_, last_, last_packed_;  ///< last_: last block that was compressed
};

/// Appends any block as a stored stream, built by hand: zlib takes five times as long to store bytes.
std::size_t wrap_as_it_is(std::span<const unsigned char> block, std::vector<unsigned char>& out);

/// Splits a share of an array, at any position in it, at the block boundaries of the array.
class BlockPacker {
 public:
  /// Largest number of bytes per call of BlockSink::packed().
  static constexpr std::size_t most = std::size_t{5} << 18;

  /// `before`: bytes of the array before the share.
  BlockPacker(std::uint64_t before, BlockSink& sink);
  void write(const void* data, std::size_t bytes);
  /// The last call.
  void finish();

 private:
  void pack(std::span<const unsigned char> block);
  void hand_over();

  BlockSink& sink_;
  BlockDeflater deflater_;
  std::size_t head_;  ///< bytes from the start of the share to the end of the block it starts in
  std::vector<unsigned char> block_, packed_;
  std::vector<std::uint64_t> lengths_;
};

}  // namespace kacanov
