// SPDX-License-Identifier: BSD-3-Clause
// Converts errors of the library to the Python exceptions of kacanov/errors.py.
#pragma once

#include <pybind11/pybind11.h>

#include <stdexcept>
#include <string>

#include <kacanov/kacanov.h>

namespace kacanov::python {

/// An argument of the wrong type: becomes TypeError.
class WrongType : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Error code returned by the C interface, with the message of the handle.
class CodeError : public std::runtime_error {
 public:
  CodeError(kacanov_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  kacanov_code code() const noexcept { return code_; }

 private:
  kacanov_code code_;
};

/// Throws CodeError unless `code` is KACANOV_OK.
void check(int code, const char* message);

/// Registers the Python exceptions of these errors, InputError, InternalError and bad_alloc with pybind11.
void register_errors();

}  // namespace kacanov::python
