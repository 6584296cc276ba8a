// SPDX-License-Identifier: BSD-3-Clause
// A law of the caller's own that a Python function says.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include <kacanov/kacanov.h>

namespace kacanov::python {

/// The library's callback for a kacanov.OwnLaw. The Python object that asks keeps the law: held from here, a
/// law that knows its operator would never be collected.
class OwnLaw {
 public:
  /// `index`: of the law among the operator's, for messages. With Python's lock.
  OwnLaw(const pybind11::object& law, std::size_t index);
  OwnLaw(const OwnLaw&) = delete;
  OwnLaw& operator=(const OwnLaw&) = delete;

  /// Makes it the law's, which keeps its moduli. It has to live as long as operators with that law do.
  void enter(kacanov_law& law);
  /// Throws what came up in the function since this was asked last; with Python's lock.
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
