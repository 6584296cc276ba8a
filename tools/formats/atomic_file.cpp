// SPDX-License-Identifier: BSD-3-Clause
// Writes a temporary file beside the target, flushes and renames it, so that a crash leaves the old file or
// the new one.
#include "formats/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <kacanov/error.hpp>

namespace kacanov {

AtomicFile::AtomicFile(std::string path)
    : path_(std::move(path)), temporary_(path_ + ".part" + std::to_string(::getpid())) {
  // A file of this name belongs to a process that has ended (its number was reused), or is someone's trap:
  // remove it, and never write through a link.
  std::remove(temporary_.c_str());
  const int handle = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (handle < 0) fail(errno);
  file_ = ::fdopen(handle, "wb");
  if (file_) return;
  const int error = errno;
  ::close(handle);
  std::remove(temporary_.c_str());
  fail(error);
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

void AtomicFile::fail(int error) {
  throw InternalError(path_ + ": cannot be written: " + std::strerror(error));
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes) fail(errno);
}

void AtomicFile::write_over(std::uint64_t place, const void* data, std::size_t bytes) {
  if (::fseeko(file_, static_cast<off_t>(place), SEEK_SET) != 0) fail(errno);
  write(data, bytes);
  if (::fseeko(file_, 0, SEEK_END) != 0) fail(errno);
}

void AtomicFile::commit(Durable durable) {
  // A full disk shows here, when buffered data are flushed.
  if (std::fflush(file_) != 0) fail(errno);
  if (durable == Durable::yes && ::fsync(::fileno(file_)) != 0) fail(errno);
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!closed || std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    std::remove(temporary_.c_str());
    fail(error);
  }
  if (durable == Durable::no) return;
  // Syncing the folder puts the new name on disk. Some file systems cannot do that; the file is complete in
  // any case.
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  const int handle = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return;
  ::fsync(handle);
  ::close(handle);
}

void sync_file(const std::string& path) {
  const int handle = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = handle >= 0 && ::fsync(handle) == 0;
  // Some file systems do not support it for folders.
  const int error = errno == EINVAL ? 0 : errno;
  if (handle >= 0) ::close(handle);
  if (!done && error != 0) throw InternalError(path + ": cannot be put on the disk: " + std::strerror(error));
}

void write_file(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace kacanov
