// SPDX-License-Identifier: BSD-3-Clause
// A file as one range of bytes: the system pages it in, nothing is copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kacanov {

/// A file that somebody shortens or rewrites in the meantime has no bytes where they are asked for: they read
/// as zeros then (no SIGBUS), and check_unchanged() says so. One thread at a time may read mapped files.
class MappedFile {
 public:
  /// Throws InputError if the file is missing, unreadable, empty or not a regular file.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const noexcept { return {data_, size_}; }
  /// To be asked once all is read, and before anything that was read is complained of. Throws InputError if
  /// the file has another length or another time of modification than when it was opened.
  void check_unchanged() const;

 private:
  std::string path_;
  int file_ = -1;
  std::int64_t modified_ = 0;  ///< nanoseconds
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace kacanov
