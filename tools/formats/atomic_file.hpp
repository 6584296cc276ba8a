// SPDX-License-Identifier: BSD-3-Clause
// Writes a file under a temporary name and gives it its own only when it is whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace kacanov {

/// Every function throws InternalError naming the file where the system refuses. Without commit() nothing
/// stays.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Puts other bytes in place of some that are written; goes on at the end.
  void write_over(std::uint64_t place, const void* data, std::size_t bytes);
  /// Closes the file and renames it; to be called last. A durable one is on the disk before it takes the
  /// place of the one before it, and survives a power cut.
  enum class Durable { no, yes };
  void commit(Durable durable = Durable::no);

 private:
  [[noreturn]] void fail(int error);

  std::string path_, temporary_;
  std::FILE* file_ = nullptr;
};

/// Puts a file, or the names in a folder, on the disk, so that they survive a power cut.
void sync_file(const std::string& path);

/// The whole of a small file at once.
void write_file(const std::string& path, std::string_view text);

}  // namespace kacanov
