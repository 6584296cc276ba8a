// SPDX-License-Identifier: BSD-3-Clause
// Output folder of a command.
#include "program/output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& folder, const std::string& why) {
  throw InputError("--output: the folder " + folder.string() + " cannot be " + why);
}

/// Returns the process named in a lock file, for a message; empty if there is none.
std::string holder(int lock) {
  std::array<char, 24> number{};
  const ssize_t size = ::pread(lock, number.data(), number.size() - 1, 0);
  const std::string text(number.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  return text.empty() ? std::string() : " (process " + text + ")";
}

/// Returns whether the open file is still the one with this name, and not one that its last holder has
/// removed.
bool still_there(int handle, const std::filesystem::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(handle, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

}  // namespace

std::filesystem::path output_folder(const Command& command, const Case& input) {
  if (!command.output.empty()) return command.output;
  return std::filesystem::path("results") / input.name;
}

OutputFolder::OutputFolder(const std::filesystem::path& folder) : lock_(folder / ".lock") {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    refuse(folder, "made" + (error ? ": " + error.message() : std::string()));
  while (handle_ < 0) {
    const int handle = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (handle < 0) refuse(folder, std::string("written to: ") + std::strerror(errno));
    // Without lock support in the file system, continue without a lock.
    if (::flock(handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string who = holder(handle);
      ::close(handle);
      throw InputError("--output: another run" + who + " is writing to the folder " + folder.string() +
                       ": wait for it, or take another folder");
    }
    if (still_there(handle, lock_))
      handle_ = handle;
    else
      ::close(handle);
  }
  const std::string own = std::to_string(::getpid());
  if (::ftruncate(handle_, 0) == 0 &&
      ::pwrite(handle_, own.data(), own.size(), 0) == static_cast<ssize_t>(own.size()))
    return;
  const int reason = errno;
  ::unlink(lock_.c_str());
  ::close(std::exchange(handle_, -1));
  refuse(folder, std::string("written to: ") + std::strerror(reason));
}

OutputFolder::~OutputFolder() {
  ::unlink(lock_.c_str());  // while it is still held
  ::close(handle_);
}

}  // namespace kacanov
