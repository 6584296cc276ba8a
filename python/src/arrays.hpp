// SPDX-License-Identifier: BSD-3-Clause
// Checks type, shape and layout of numpy arrays, and uses them without a copy.
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

/// Requirements on an array; an extent of −1 is arbitrary.
struct Wanted {
  const char* name;                              ///< name of the argument
  std::vector<std::vector<std::ptrdiff_t>> any;  ///< allowed shapes
  bool contiguous = true;                        ///< must be C-contiguous
  bool writable = false;
};

/// "float64", "float32", "int32", "uint16": numpy name of a type that the library takes.
template <class T>
const char* type_name();

/// Returns the object as an array of T in native byte order, without a copy. Throws WrongType if it is not an
/// array of that type, InputError for another shape or layout: "x: expected a C-contiguous float64 array of
/// shape (81,), got float64 of shape (80,)".
template <class T>
pybind11::array wanted_array(pybind11::handle object, const Wanted& wanted);

/// Entries of the array.
template <class T>
std::span<const T> entries(const pybind11::array& array) {
  return {static_cast<const T*>(array.data()), static_cast<std::size_t>(array.size())};
}
template <class T>
std::span<T> entries(pybind11::array& array) {
  return {static_cast<T*>(array.mutable_data()), static_cast<std::size_t>(array.size())};
}

/// Returns a new array of this shape with uninitialised entries.
template <class T>
pybind11::array new_array(const std::vector<std::ptrdiff_t>& shape) {
  return pybind11::array(pybind11::dtype::of<T>(), shape);
}

/// Shape of an array.
std::vector<std::ptrdiff_t> shape_of(const pybind11::array& array);

}  // namespace kacanov::python
