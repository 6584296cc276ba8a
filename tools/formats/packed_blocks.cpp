// SPDX-License-Identifier: BSD-3-Clause
// Arrays cut into blocks of one length, each packed by zlib by itself, as VTK keeps them.
#include "formats/packed_blocks.hpp"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <span>

namespace kacanov {
namespace {

/// Length of the stream that is written to `to`, which has room for it.
std::size_t deflate_block(std::span<const unsigned char> block, int level, unsigned char* to,
                          std::size_t room) {
  uLongf length = room;
  if (compress2(to, &length, block.data(), block.size(), level) != Z_OK) throw std::bad_alloc();
  return length;
}

}  // namespace

std::size_t pack_block(std::span<const unsigned char> block, std::vector<unsigned char>& out) {
  // A part from its middle tells what the whole would come to.
  constexpr std::size_t sample = 2048;
  const std::size_t before = out.size(), room = compressBound(block.size());
  out.resize(before + room);
  int level = Z_BEST_SPEED;
  if (block.size() >= 8 * sample) {
    const std::size_t tried =
        deflate_block(block.subspan(block.size() / 2, sample), level, out.data() + before, room);
    if (tried * 10 > sample * 7) level = Z_NO_COMPRESSION;
  }
  const std::size_t length = deflate_block(block, level, out.data() + before, room);
  out.resize(before + length);
  return length;
}

BlockPacker::BlockPacker(std::uint64_t before, BlockSink& sink)
    : sink_(sink), head_((block_bytes - before % block_bytes) % block_bytes) {}

void BlockPacker::write(const void* data, std::size_t bytes) {
  const unsigned char* from = static_cast<const unsigned char*>(data);
  while (bytes > 0) {
    const std::size_t whole = head_ > 0 ? head_ : block_bytes, some = std::min(bytes, whole - block_.size());
    block_.insert(block_.end(), from, from + some);
    from += some;
    bytes -= some;
    if (block_.size() < whole) continue;
    if (head_ > 0) {
      sink_.loose(block_);
      head_ = 0;
    } else {
      pack();
    }
    block_.clear();
  }
}

void BlockPacker::pack() {
  lengths_.push_back(pack_block(block_, packed_));
  if (packed_.size() + 2 * block_bytes > most) hand_over();
}

void BlockPacker::hand_over() {
  if (!lengths_.empty()) sink_.packed(packed_, lengths_);
  packed_.clear();
  lengths_.clear();
}

void BlockPacker::finish() {
  hand_over();
  if (!block_.empty()) sink_.loose(block_);
  block_.clear();
}

}  // namespace kacanov
