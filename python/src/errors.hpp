// SPDX-License-Identifier: BSD-3-Clause
// From the library's failures to Python's exceptions, which kacanov/errors.py has.
#pragma once

#include <pybind11/pybind11.h>

#include <stdexcept>
#include <string>

#include <kacanov/kacanov.h>

namespace kacanov::python {

/// An argument of another kind than expected: TypeError.
class WrongType : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a call of the C interface has returned, with the handle's words.
class CodeError : public std::runtime_error {
 public:
  CodeError(kacanov_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  kacanov_code code() const noexcept { return code_; }

 private:
  kacanov_code code_;
};

/// Throws CodeError unless `code` is KACANOV_OK.
void check(int code, const char* message);

/// Tells pybind11 which exception of Python each of these, InputError, InternalError and bad_alloc is.
void register_errors();

}  // namespace kacanov::python
