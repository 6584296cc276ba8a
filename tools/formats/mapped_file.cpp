// SPDX-License-Identifier: BSD-3-Clause
// The file mapped by the system, and unmapped at the end.
#include "formats/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <kacanov/error.hpp>

namespace kacanov {

MappedFile::MappedFile(const std::string& path) {
  const auto refuse = [&](const std::string& why) -> void { throw InputError(path + ": " + why); };
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) refuse(std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  const bool known = ::fstat(file, &status) == 0;
  void* mapped = MAP_FAILED;
  int error = errno;
  if (known && S_ISREG(status.st_mode) && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
    error = errno;
  }
  ::close(file);
  if (known && S_ISDIR(status.st_mode)) refuse("is a folder, not a file");
  if (known && !S_ISREG(status.st_mode)) refuse("is not a regular file");
  if (known && status.st_size == 0) refuse("is empty");
  if (mapped == MAP_FAILED) refuse(std::string("cannot be read: ") + std::strerror(error));
  ::madvise(mapped, size_, MADV_SEQUENTIAL);
  data_ = static_cast<const char*>(mapped);
}

MappedFile::~MappedFile() { ::munmap(const_cast<char*>(data_), size_); }

}  // namespace kacanov
