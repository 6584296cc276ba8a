// SPDX-License-Identifier: BSD-3-Clause
// Parts of the extension module _kacanov.
#pragma once

#include <pybind11/pybind11.h>

namespace kacanov::python {

void bind_operator(pybind11::module_& module);
void bind_solve(pybind11::module_& module);

}  // namespace kacanov::python
