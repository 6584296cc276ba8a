// SPDX-License-Identifier: BSD-3-Clause
// Binary files that are whole or refused. Layout: a line with name and version; the length of the header, 8
// bytes; the header, JSON; a hash of all this, 8 bytes; the content, piece after piece; the hash chained
// through the pieces, 8 bytes. Numbers in the machine's byte order.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"
#include "mesh/plain_stream.hpp"

namespace kacanov {

/// Throws InternalError naming the file where the system refuses. Without commit() nothing stays.
class HashedWriter {
 public:
  /// `magic` is the first line, its end included.
  HashedWriter(const std::string& path, std::string_view magic, const nlohmann::json& header);
  /// One piece.
  void write(const void* data, std::size_t bytes);
  void commit();

 private:
  AtomicFile file_;
  std::uint64_t hash_ = 0;
};

/// Throws InputError naming the file: not there, of another kind or version, cut short, or damaged.
class HashedReader {
 public:
  /// Reads and proves the header. `kind` is what messages call the file.
  HashedReader(const std::string& path, std::string_view magic, const std::string& kind);
  const nlohmann::json& header() const noexcept { return header_; }
  /// Throws where that much content cannot be left.
  void expect(std::uint64_t entries, std::size_t bytes_each) const;
  /// One piece, as it was written. What it holds is proven only by finish().
  void read(void* data, std::size_t bytes);
  void finish();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void take(void* data, std::size_t bytes);
  void check_hash();

  std::string path_, kind_;
  PlainFile stream_;
  std::uint64_t size_ = 0, left_ = 0, hash_ = 0;
  nlohmann::json header_;
};

/// Does work that looks into a header: what it misses there is the file's fault, an InputError naming it.
template <class Work>
decltype(auto) reading_header(const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": its header has not what is expected: " + error.what());
  }
}

}  // namespace kacanov
