// SPDX-License-Identifier: BSD-3-Clause
// The extension module _kacanov, on which the package's Python files are based.
#include "module.hpp"

#include <kacanov/kacanov.h>
#include "errors.hpp"

PYBIND11_MODULE(_kacanov, module) {
  using namespace kacanov::python;
  module.doc() = "The compiled part of the package kacanov, which is what to import.";
  module.attr("version") = kacanov_version();
  register_errors();
  bind_operator(module);
  bind_solve(module);
}
