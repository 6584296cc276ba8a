// SPDX-License-Identifier: BSD-3-Clause
// What the module _kacanov is put together of.
#pragma once

#include <pybind11/pybind11.h>

namespace kacanov::python {

void bind_operator(pybind11::module_& module);
void bind_solve(pybind11::module_& module);

}  // namespace kacanov::python
