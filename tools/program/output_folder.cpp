// SPDX-License-Identifier: BSD-3-Clause
// The folder a command writes to.
#include "program/output_folder.hpp"

#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"

namespace kacanov {

std::filesystem::path output_folder(const Command& command, const Case& input) {
  if (!command.output.empty()) return command.output;
  return std::filesystem::path("results") / input.name;
}

void prepare_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw InputError("--output: the folder " + folder.string() + " cannot be made" +
                     (error ? ": " + error.message() : ""));
  }
  const std::filesystem::path probe = folder / ".writable";
  try {
    write_file(probe.string(), "");
  } catch (const InternalError& refusal) {
    throw InputError("--output: the folder " + folder.string() + " cannot be written to: " + refusal.what());
  }
  std::filesystem::remove(probe, error);
}

}  // namespace kacanov
