// SPDX-License-Identifier: BSD-3-Clause
// Reads obstacles from files of their own.
#pragma once

#include "case/case_file.hpp"

namespace kacanov {

/// Returns the model of the case with the obstacles read from files. Throws InputError naming the key and the
/// file.
Model model_with_files(const Case& input);

}  // namespace kacanov
