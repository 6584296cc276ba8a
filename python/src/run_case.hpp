// SPDX-License-Identifier: BSD-3-Clause
// Solves cases inside a Python process, alone or with the other ranks of a communicator.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "case/case_file.hpp"

namespace kacanov::python {

/// Parses the text of a case; `mesh`: content of its mesh, if it is not in a file.
Case read_case(const std::string& text, const std::string& path, std::optional<std::string> mesh);

/// Implements Case.solve of kacanov/case.py. Returns the solution or None, the exception of this rank or
/// None, and, if other ranks raised, (rank, whether it is a KeyboardInterrupt, text) for one of them, or
/// None. Either all ranks raise or none. Collective over given["comm"].
pybind11::tuple run_case(const pybind11::dict& given);

}  // namespace kacanov::python
