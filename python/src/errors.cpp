// SPDX-License-Identifier: BSD-3-Clause
// Converts errors of the library to the Python exceptions of kacanov/errors.py.
#include "errors.hpp"

#include <new>

#include <kacanov/error.hpp>

namespace py = pybind11;

namespace kacanov::python {
namespace {

void raise(const char* name, const char* message, int code = KACANOV_OK) {
  const py::object type = py::module_::import("kacanov.errors").attr(name);
  const py::object error = type(py::str(message));
  if (code != KACANOV_OK) error.attr("code") = code;
  PyErr_SetObject(type.ptr(), error.ptr());
}

void raise_code(const CodeError& error) {
  switch (error.code()) {
    case KACANOV_ERROR_MEMORY: PyErr_SetString(PyExc_MemoryError, error.what()); return;
    case KACANOV_ERROR_STATE: raise("StateError", error.what(), error.code()); return;
    case KACANOV_ERROR_INTERNAL: raise("InternalError", error.what(), error.code()); return;
    default: raise("InputError", error.what(), error.code());
  }
}

void translate(std::exception_ptr pointer) {
  if (!pointer) return;
  try {
    std::rethrow_exception(pointer);
  } catch (const CodeError& error) {
    raise_code(error);
  } catch (const WrongType& error) {
    PyErr_SetString(PyExc_TypeError, error.what());
  } catch (const InputError& error) {
    raise("InputError", error.what());
  } catch (const InternalError& error) {
    raise("InternalError", error.what());
  }
}

}  // namespace

void check(int code, const char* message) {
  if (code == KACANOV_OK) return;
  const bool silent = message == nullptr || *message == '\0';
  throw CodeError(static_cast<kacanov_code>(code), silent ? kacanov_code_text(code) : message);
}

void register_errors() { py::register_exception_translator(translate); }

}  // namespace kacanov::python
