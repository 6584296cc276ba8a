// SPDX-License-Identifier: BSD-3-Clause
// Session folder of Open MPI during a run.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

namespace kacanov {

/// Creates a folder that stays locked while its process, or one that has inherited handle(), lives. The
/// constructor also removes folders that killed processes of this user have left beside it.
class LockedFolder {
 public:
  /// Uses the first of `bases` in which a folder can be created and which has enough space. Throws
  /// InternalError with the reason for each if none qualifies.
  explicit LockedFolder(std::span<const std::filesystem::path> bases);
  /// Removes the folder.
  ~LockedFolder();
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }
  int handle() const noexcept { return handle_; }

 private:
  std::filesystem::path path_;
  int handle_ = -1;  ///< closed by exec()
};

/// Open MPI's session folder of this process, set in its environment. By default all programs of a user share
/// one and remove it at their end, which breaks programs that are starting (open-mpi/ompi issue 8510). None
/// is created if the user sets OMPI_MCA_orte_tmpdir_base, or if another process started this one as a rank.
class MpiFolder {
 public:
  /// Call it before MPI_Init or mpiexec. Uses TMPDIR, /tmp or /dev/shm, else creates `last_resort`. Throws
  /// InternalError if no folder can be created.
  explicit MpiFolder(const std::filesystem::path& last_resort = {});
  /// Removes the folder; call it after MPI_Finalize or the end of mpiexec.
  ~MpiFolder();
  MpiFolder(const MpiFolder&) = delete;
  MpiFolder& operator=(const MpiFolder&) = delete;

  /// Call it in a child of this process: the program it starts by exec() holds the lock too.
  void hand_down() const noexcept;

 private:
  std::optional<LockedFolder> folder_;
};

}  // namespace kacanov
