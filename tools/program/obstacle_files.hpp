// SPDX-License-Identifier: BSD-3-Clause
// Obstacles that are in files of their own.
#pragma once

#include "case/case_file.hpp"

namespace kacanov {

/// The case's model with what the files of its obstacles hold. Throws InputError naming the key and the file.
Model model_with_files(const Case& input);

}  // namespace kacanov
