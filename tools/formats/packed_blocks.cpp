// SPDX-License-Identifier: BSD-3-Clause
// Splits arrays into blocks of equal length, each compressed by zlib on its own, as VTK stores them.
#include "formats/packed_blocks.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <span>

namespace kacanov {

struct BlockDeflater::Stream : z_stream {
  Stream() : z_stream{} {
    if (deflateInit(this, Z_BEST_SPEED) != Z_OK) throw std::bad_alloc();
  }
  ~Stream() { deflateEnd(this); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

BlockDeflater::BlockDeflater() : stream_(std::make_unique<Stream>()) {}
BlockDeflater::~BlockDeflater() = default;

std::span<const unsigned char> BlockDeflater::shortened(std::span<const unsigned char> block) {
  room_.resize(std::max<std::size_t>(room_.size(), deflateBound(stream_.get(), block.size())));
  deflateReset(stream_.get());
  stream_->next_in = const_cast<unsigned char*>(block.data());  // zlib only reads it
  stream_->avail_in = static_cast<uInt>(block.size());
  stream_->next_out = room_.data();
  stream_->avail_out = static_cast<uInt>(room_.size());
  if (deflate(stream_.get(), Z_FINISH) != Z_STREAM_END) throw std::bad_alloc();
  return std::span(room_).first(stream_->total_out);
}

std::size_t BlockDeflater::pack(std::span<const unsigned char> block, std::vector<unsigned char>& out) {
  // Constant fields repeat the same block.
  const bool again = std::equal(block.begin(), block.end(), last_.begin(), last_.end());
  if (!again) {
    // A sample from the middle predicts the compression ratio of the block.
    constexpr std::size_t sample = 2048;
    if (block.size() >= 8 * sample &&
        shortened(block.subspan(block.size() / 2, sample)).size() * 10 > sample * 7)
      return wrap_as_it_is(block, out);
    const auto packed = shortened(block);
    last_packed_.assign(packed.begin(), packed.end());
    last_.assign(block.begin(), block.end());
  }
  out.insert(out.end(), last_packed_.begin(), last_packed_.end());
  return last_packed_.size();
}

std::size_t wrap_as_it_is(std::span<const unsigned char> block, std::vector<unsigned char>& out) {
  constexpr std::size_t longest = 65535;  // longest stored block (RFC 1951, 3.2.4)
  const std::size_t before = out.size();
  const auto put = [&](auto... byte) { out.insert(out.end(), {static_cast<unsigned char>(byte)...}); };
  put(0x78, 0x01);
  for (std::size_t first = 0; first == 0 || first < block.size(); first += longest) {
    const auto piece = block.subspan(first, std::min(longest, block.size() - first));
    const std::size_t low = piece.size() & 0xff, high = piece.size() >> 8;
    put(first + piece.size() == block.size() ? 1 : 0, low, high, 0xff - low, 0xff - high);
    out.insert(out.end(), piece.begin(), piece.end());
  }
  const uLong sum = adler32(adler32(0, nullptr, 0), block.data(), static_cast<uInt>(block.size()));
  put(sum >> 24 & 0xff, sum >> 16 & 0xff, sum >> 8 & 0xff, sum & 0xff);
  return out.size() - before;
}

BlockPacker::BlockPacker(std::uint64_t before, BlockSink& sink)
    : sink_(sink), head_((block_bytes - before % block_bytes) % block_bytes) {
  packed_.reserve(most);
}

void BlockPacker::write(const void* data, std::size_t bytes) {
  const unsigned char* from = static_cast<const unsigned char*>(data);
  while (bytes > 0) {
    if (head_ == 0 && block_.empty() && bytes >= block_bytes) {
      pack({from, block_bytes});
      from += block_bytes;
      bytes -= block_bytes;
      continue;
    }
    const std::size_t whole = head_ > 0 ? head_ : block_bytes, some = std::min(bytes, whole - block_.size());
    block_.insert(block_.end(), from, from + some);
    from += some;
    bytes -= some;
    if (block_.size() < whole) continue;
    if (head_ > 0) {
      sink_.loose(block_);
      head_ = 0;
    } else {
      pack(block_);
    }
    block_.clear();
  }
}

void BlockPacker::pack(std::span<const unsigned char> block) {
  lengths_.push_back(deflater_.pack(block, packed_));
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
