// SPDX-License-Identifier: BSD-3-Clause
// Where Open MPI keeps what it needs while a run lasts.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

namespace kacanov {

/// A new folder that is locked while its process, or one that has inherited handle(), lives. Making one
/// removes those that killed processes of this user have left beside it.
class LockedFolder {
 public:
  /// In the first of `bases` that lets a folder be made and has some room. Throws InternalError, with the
  /// reason for each, where none does.
  explicit LockedFolder(std::span<const std::filesystem::path> bases);
  /// Removes it.
  ~LockedFolder();
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }
  int handle() const noexcept { return handle_; }

 private:
  std::filesystem::path path_;
  int handle_ = -1;  ///< closed by exec()
};

/// A folder of this process's own for Open MPI's session, named in its environment. Otherwise all programs of
/// a user share one, remove it as they end, and others that start just then fail (open-mpi/ompi issue 8510).
/// There is none where the user has said where (OMPI_MCA_orte_tmpdir_base), or where another process has
/// started this one as a rank.
class MpiFolder {
 public:
  /// Before MPI_Init or mpiexec. In TMPDIR, /tmp or /dev/shm, or else in `last_resort`, which is made. Throws
  /// InternalError where no folder can be made.
  explicit MpiFolder(const std::filesystem::path& last_resort = {});
  /// Removes it: after MPI_Finalize or the end of mpiexec.
  ~MpiFolder();
  MpiFolder(const MpiFolder&) = delete;
  MpiFolder& operator=(const MpiFolder&) = delete;

  /// In a child of this process: what it becomes by exec() holds the lock as well.
  void hand_down() const noexcept;

 private:
  std::optional<LockedFolder> folder_;
};

}  // namespace kacanov
