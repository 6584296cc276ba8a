// SPDX-License-Identifier: BSD-3-Clause
// Output folder of a command.
#pragma once

#include <filesystem>
#include <string>

#include "case/case_file.hpp"
#include "program/command.hpp"

namespace kacanov {

/// Returns the folder given on the command line, else results/<case name>.
std::filesystem::path output_folder(const Command& command, const Case& input);

/// Locks the output folder for one command: two runs into one folder would mix their files. The lock is on
/// the file `.lock` and ends with the process, however that ends.
class OutputFolder {
 public:
  /// Creates the folder if it is missing and checks that files can be written to it. Throws InputError,
  /// naming the process that holds the lock, if there is one.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::filesystem::path lock_;
  int handle_ = -1;
};

}  // namespace kacanov
