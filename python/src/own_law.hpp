// SPDX-License-Identifier: BSD-3-Clause
// A material law defined by a Python function.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include <kacanov/kacanov.h>

namespace kacanov::python {

/// Callback of the library for a kacanov.OwnLaw. The Python operator object holds the law: a reference from
/// here would form a cycle that is never collected if the law refers to its operator.
class OwnLaw {
 public:
  /// `index`: index of the law in the operator, for messages. Requires the GIL.
  OwnLaw(const pybind11::object& law, std::size_t index);
  OwnLaw(const OwnLaw&) = delete;
  OwnLaw& operator=(const OwnLaw&) = delete;

  /// Installs the callback in the law, which keeps its moduli. Must outlive operators with that law.
  void enter(kacanov_law& law);
  /// Throws an exception raised by the function since the last call; requires the GIL.
  void raise();

 private:
  static int evaluate(void* self, const kacanov_law_points* points);
  void fill(const kacanov_law_points& points) const;
  void take(const pybind11::object& values, const char* name, std::size_t count, double* to) const;

  pybind11::weakref law_;
  std::string name_;
  double yield_strain_;
  std::exception_ptr raised_;
};

}  // namespace kacanov::python
