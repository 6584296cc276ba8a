// SPDX-License-Identifier: BSD-3-Clause
// A file as one range of bytes: the system pages it in, nothing is copied.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kacanov {

class MappedFile {
 public:
  /// Throws InputError if the file is missing, unreadable, empty or not a regular file.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const noexcept { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace kacanov
