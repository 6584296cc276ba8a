// SPDX-License-Identifier: BSD-3-Clause
// Session folder of Open MPI during a run.
#include "program/mpi_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include <kacanov/error.hpp>
#include "program/launch.hpp"

namespace kacanov {
namespace {

namespace fs = std::filesystem;

constexpr const char* tmpdir_variable = "OMPI_MCA_orte_tmpdir_base";
/// Differs from the names of version 0.2, whose folders have no lock.
constexpr const char* first_letters = "kacanov-mpi-locked-";
/// A session of eight ranks needs 200 kB here; shared memory is in /dev/shm.
constexpr std::uintmax_t least_room = 1 << 20;

/// Opens and locks a folder; returns -1 if another process holds the lock, or if it is not a folder of this
/// user.
int open_locked(const fs::path& folder, bool lock_needed) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (handle < 0) return -1;
  struct stat opened {
  }, named{};
  const bool locked = ::flock(handle, LOCK_EX | LOCK_NB) == 0;
  // Without lock support in the file system, continue without a lock.
  const bool usable = locked || (!lock_needed && errno != EWOULDBLOCK);
  if (usable && ::fstat(handle, &opened) == 0 && ::stat(folder.c_str(), &named) == 0 &&
      opened.st_ino == named.st_ino && opened.st_dev == named.st_dev && opened.st_uid == ::geteuid())
    return handle;
  ::close(handle);
  return -1;
}

/// Removes unlocked folders in `base`: their processes have ended.
void remove_left_over(const fs::path& base) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator at(base, error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().rfind(first_letters, 0) == 0) found.push_back(at->path());
  for (const fs::path& folder : found) {
    const int handle = open_locked(folder, true);
    if (handle < 0) continue;
    fs::remove_all(folder, error);
    ::close(handle);
  }
}

std::vector<fs::path> bases(const fs::path& last_resort) {
  std::vector<fs::path> all;
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  if (!error) all.push_back(temporary);
  for (const fs::path base : {"/tmp", "/dev/shm"})
    if (base != temporary && fs::is_directory(base, error)) all.push_back(base);
  if (!last_resort.empty()) all.push_back(last_resort);
  return all;
}

}  // namespace

LockedFolder::LockedFolder(std::span<const fs::path> bases) {
  std::string reasons;
  for (const fs::path& base : bases) {
    std::error_code error;
    fs::create_directories(base, error);
    remove_left_over(base);
    const fs::space_info space = fs::space(base, error);
    std::string reason = "no room";
    if (error || space.available >= least_room) {
      for (int tries = 0; handle_ < 0 && tries < 100; ++tries) {  // another run may remove it before the lock
        std::string path = (fs::absolute(base, error) / (std::string(first_letters) + "XXXXXX")).string();
        if (::mkdtemp(path.data()) == nullptr) break;
        path_ = path;
        handle_ = open_locked(path, false);
      }
      if (handle_ >= 0) return;
      reason = std::strerror(errno);
    }
    reasons += (reasons.empty() ? "" : ", ") + base.string() + " (" + reason + ")";
  }
  throw InternalError("Open MPI needs a folder for its files, and none can be made in " + reasons +
                      ": name one that can be written by TMPDIR, or by " + tmpdir_variable +
                      " where that is set");
}

LockedFolder::~LockedFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);  // while it is still locked
  ::close(handle_);
}

MpiFolder::MpiFolder(const fs::path& last_resort) {
  if (started_by_mpi()) return;
  if (const char* given = std::getenv(tmpdir_variable)) {
    // If Open MPI cannot create a folder there, it exits with a code of its own, so try it first.
    const std::array only{fs::path(given)};
    const LockedFolder trial(only);
    return;
  }
  folder_.emplace(bases(last_resort));
  setenv(tmpdir_variable, folder_->path().c_str(), 1);
}

MpiFolder::~MpiFolder() {
  if (!folder_) return;
  const char* now = std::getenv(tmpdir_variable);
  if (now != nullptr && now == folder_->path()) unsetenv(tmpdir_variable);
}

void MpiFolder::hand_down() const noexcept {
  if (folder_) ::fcntl(folder_->handle(), F_SETFD, 0);
}

}  // namespace kacanov
