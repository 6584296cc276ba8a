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

/// Makes the folder where it is missing and proves that files can be written to it. Throws InputError.
void prepare_folder(const std::filesystem::path& folder);

}  // namespace kacanov
