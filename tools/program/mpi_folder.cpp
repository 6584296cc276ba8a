// SPDX-License-Identifier: BSD-3-Clause
// Where Open MPI keeps what it needs while a run lasts.
#include "program/mpi_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "program/launch.hpp"

namespace kacanov {
namespace {

constexpr const char* tmpdir_variable = "OMPI_MCA_orte_tmpdir_base";

}  // namespace

MpiFolder::MpiFolder() {
  if (std::getenv(tmpdir_variable) != nullptr || started_by_mpi()) return;
  std::error_code error;
  const std::filesystem::path base = std::filesystem::temp_directory_path(error);
  if (error) return;
  std::string path = (base / "kacanov-mpi-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr) return;
  setenv(tmpdir_variable, path.c_str(), 1);
  path_ = path;
}

MpiFolder::~MpiFolder() {
  if (path_.empty()) return;
  const char* now = std::getenv(tmpdir_variable);
  if (now != nullptr && now == path_) unsetenv(tmpdir_variable);
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace kacanov
