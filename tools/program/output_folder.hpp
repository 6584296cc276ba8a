// SPDX-License-Identifier: BSD-3-Clause
// The folder a command writes to.
#pragma once

#include <filesystem>
#include <string>

#include "case/case_file.hpp"
#include "program/command.hpp"

namespace kacanov {

/// The folder of a command: as given, else results/<case name>.
std::filesystem::path output_folder(const Command& command, const Case& input);

/// A folder that one command writes to, from when it is prepared until it is let go: two runs into one folder
/// would mix their files. The mark is the file `.lock`; it goes with the process, however that ends.
class OutputFolder {
 public:
  /// Makes the folder where it is missing and proves that files can be written to it. Throws InputError,
  /// naming the process at work there where there is one.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::filesystem::path lock_;
  int handle_ = -1;
};

}  // namespace kacanov
