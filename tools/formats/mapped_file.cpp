// SPDX-License-Identifier: BSD-3-Clause
// A file mapping that survives truncation of the file.
#include "formats/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

/// The only range in which bus errors are handled; elsewhere the earlier handler applies.
std::atomic<const char*> guarded_begin = nullptr, guarded_end = nullptr;
struct sigaction earlier {};  // earlier handler of the process

/// Maps a page of zeros where the file no longer has data; the read that faulted is retried.
void put_zeros(int, siginfo_t* info, void*) {
  const auto* at = static_cast<const char*>(info->si_addr);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  void* start = reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(at) / page * page);
  const bool ours = at >= guarded_begin.load() && at < guarded_end.load();
  if (!ours || ::mmap(start, page, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED)
    sigaction(SIGBUS, &earlier, nullptr);
}

/// Starts handling bus errors in the range; an empty range stops it.
void guard(const char* data, std::size_t size) {
  const bool guards = guarded_begin.load() != nullptr;
  guarded_begin = data;
  guarded_end = data + size;
  if (size > 0) {
    struct sigaction action {};
    action.sa_sigaction = put_zeros;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGBUS, &action, guards ? nullptr : &earlier);
  } else if (guards) {
    sigaction(SIGBUS, &earlier, nullptr);
  }
}

std::int64_t modification(const struct stat& status) {
  return std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
}

}  // namespace

MappedFile::MappedFile(const std::string& path) : path_(path) {
  const auto refuse = [&](const std::string& why) -> void {
    if (file_ >= 0) ::close(file_);
    throw InputError(path + ": " + why);
  };
  file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) refuse(std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  if (::fstat(file_, &status) != 0) refuse(std::string("cannot be read: ") + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse("is a folder, not a file");
  if (!S_ISREG(status.st_mode)) refuse("is not a regular file");
  if (status.st_size == 0) refuse("is empty");
  size_ = static_cast<std::size_t>(status.st_size);
  modified_ = modification(status);
  void* mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file_, 0);
  if (mapped == MAP_FAILED) refuse(std::string("cannot be read: ") + std::strerror(errno));
  ::madvise(mapped, size_, MADV_SEQUENTIAL);
  data_ = static_cast<const char*>(mapped);
  guard(data_, size_);
}

MappedFile::~MappedFile() {
  guard(nullptr, 0);
  ::munmap(const_cast<char*>(data_), size_);
  ::close(file_);
}

void MappedFile::check_unchanged() const {
  struct stat status {};
  if (::fstat(file_, &status) == 0 && static_cast<std::size_t>(status.st_size) == size_ &&
      modification(status) == modified_)
    return;
  throw InputError(path_ + ": was changed while it was read (" + std::to_string(size_) +
                   " bytes when it was opened)");
}

}  // namespace kacanov
