// SPDX-License-Identifier: BSD-3-Clause
// A solve within the process of Python, of its own or with the other ranks of a communicator.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "case/case_file.hpp"

namespace kacanov::python {

/// A case and, where that is not in a file, the content of its mesh's.
Case read_case(const std::string& text, const std::string& path, std::optional<std::string> mesh);

/// What Case.solve in kacanov/case.py asks for. Returns what is solved or None, what this rank has raised on
/// the way or None, and where other ranks have (rank, whether it is a KeyboardInterrupt, text) of one of
/// them, or None. Either all ranks raise or none does. Collective over given["comm"].
pybind11::tuple run_case(const pybind11::dict& given);

}  // namespace kacanov::python
