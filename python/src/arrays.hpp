// SPDX-License-Identifier: BSD-3-Clause
// numpy arrays as they come: used where they lie, or refused with what was expected.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kacanov::python {

/// What an array has to be; extents of −1 may be any.
struct Wanted {
  const char* name;                              ///< of the argument
  std::vector<std::vector<std::ptrdiff_t>> any;  ///< shapes of which it has to have one
  bool contiguous = true;                        ///< C-contiguous
  bool writable = false;
};

/// "float64", "float32", "int32", "uint16": of what the library takes.
template <class T>
const char* type_name();

/// The object as an array of T in the machine's byte order, without a copy. Throws WrongType where it is
/// no array of that type, InputError where its shape or layout is another: "x: expected a C-contiguous
/// float64 array of shape (81,), got float64 of shape (80,)".
template <class T>
pybind11::array wanted_array(pybind11::handle object, const Wanted& wanted);

/// Its entries.
template <class T>
std::span<const T> entries(const pybind11::array& array) {
  return {static_cast<const T*>(array.data()), static_cast<std::size_t>(array.size())};
}
template <class T>
std::span<T> entries(pybind11::array& array) {
  return {static_cast<T*>(array.mutable_data()), static_cast<std::size_t>(array.size())};
}

/// A new array of this shape with undefined entries.
template <class T>
pybind11::array new_array(const std::vector<std::ptrdiff_t>& shape) {
  return pybind11::array(pybind11::dtype::of<T>(), shape);
}

/// Shape of an array.
std::vector<std::ptrdiff_t> shape_of(const pybind11::array& array);

}  // namespace kacanov::python
