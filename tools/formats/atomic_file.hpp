// SPDX-License-Identifier: BSD-3-Clause
// Writes a file under a temporary name and renames it once it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace kacanov {

/// Every function throws InternalError naming the file if the system call fails. Without commit() no file is
/// left.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Overwrites bytes that were written before; the next write() appends at the end.
  void write_over(std::uint64_t place, const void* data, std::size_t bytes);
  /// Closes the file and renames it; the last call. With Durable::yes the data are synced to disk before the
  /// rename, so that the file survives a power failure.
  enum class Durable { no, yes };
  void commit(Durable durable = Durable::no);

 private:
  [[noreturn]] void fail(int error);

  std::string path_, temporary_;
  std::FILE* file_ = nullptr;
};

/// Syncs a file, or the directory entries of a folder, to disk, so that they survive a power failure.
void sync_file(const std::string& path);

/// Writes a small file in one call.
void write_file(const std::string& path, std::string_view text);

}  // namespace kacanov
