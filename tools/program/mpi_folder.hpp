// SPDX-License-Identifier: BSD-3-Clause
// Where Open MPI keeps what it needs while a run lasts.
#pragma once

#include <string>

namespace kacanov {

/// A folder of this process's own for Open MPI's session, told to it by its environment. Otherwise all
/// programs of a user share one, take it away as they end, and others that start just then fail
/// (open-mpi/ompi issue 8510). It is none, and what is there stays, where the user has said where
/// (OMPI_MCA_orte_tmpdir_base), where somebody else has started this process as a rank, or where no folder
/// can be made.
class MpiFolder {
 public:
  /// Before MPI_Init or mpiexec.
  MpiFolder();
  /// Removes it: after MPI_Finalize or the end of mpiexec.
  ~MpiFolder();
  MpiFolder(const MpiFolder&) = delete;
  MpiFolder& operator=(const MpiFolder&) = delete;

 private:
  std::string path_;
};

}  // namespace kacanov
