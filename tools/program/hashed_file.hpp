// SPDX-License-Identifier: BSD-3-Clause
// Binary files with checksums, which are read completely or rejected. Layout: a line with name and version;
// the length of the header, 8 bytes; the header, JSON; a hash of all this, 8 bytes; the content, piece by
// piece; the hash chained over the pieces, 8 bytes. Numbers are in machine byte order.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {

/// Throws InternalError naming the file if a system call fails. Without commit() no file is left.
class HashedWriter {
 public:
  /// `magic` is the first line, with its line end.
  HashedWriter(const std::string& path, std::string_view magic, const nlohmann::json& header);
  /// Writes one piece.
  void write(const void* data, std::size_t bytes);
  void commit();

 private:
  AtomicFile file_;
  std::uint64_t hash_ = 0;
};

/// Throws InputError naming the file if it is missing, of another kind or version, truncated, or damaged.
class HashedReader {
 public:
  /// Reads and verifies the header. `kind` names the type of file in messages.
  HashedReader(const std::string& path, std::string_view magic, const std::string& kind);
  const nlohmann::json& header() const noexcept { return header_; }
  /// Throws if the file is too short for that much content.
  void expect(std::uint64_t entries, std::size_t bytes_each) const;
  /// Reads one piece with the size it was written with. Only finish() verifies its content.
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

/// Runs `work`, which parses a header; a missing or invalid entry becomes an InputError naming the file.
template <class Work>
decltype(auto) reading_header(const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": its header has not what is expected: " + error.what());
  }
}

}  // namespace kacanov
