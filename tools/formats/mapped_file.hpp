// SPDX-License-Identifier: BSD-3-Clause
// Memory-mapped file, read as one range of bytes without a copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kacanov {

/// If another process truncates or rewrites the file, missing pages read as zeros (no SIGBUS), and
/// check_unchanged() throws. Only one thread at a time may read mapped files.
class MappedFile {
 public:
  /// Throws InputError if the file is missing, unreadable, empty or not a regular file.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const noexcept { return {data_, size_}; }
  /// Call it after reading, and before reporting an error in the content. Throws InputError if the length or
  /// the modification time of the file has changed since it was opened.
  void check_unchanged() const;

 private:
  std::string path_;
  int file_ = -1;
  std::int64_t modified_ = 0;  ///< nanoseconds
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace kacanov
